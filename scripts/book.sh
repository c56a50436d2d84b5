#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds the book (docs/, mkdocs.yml) into target/book. Fails on a broken link, a missing anchor, a page that the contents do
# not list, and a resource that a reader's browser would load from the network. MkDocs comes from PyPI, see python_tools.sh.
#
#   scripts/book.sh            then open target/book/index.html
#   scripts/book.sh --serve    at http://127.0.0.1:8000, rebuilt when a page changes
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
'' | --serve) ;;
*) echo "book: unknown option $1; see the head of scripts/book.sh" >&2 && exit 2 ;;
esac
tools=$(scripts/python_tools.sh --book)
# The live page, which the tutorial shows in a frame. The copy here is ignored by git.
"$(scripts/checks/foveate.sh)" live --page docs/live.html
# Hides the theme's note about its successor, which reads the same mkdocs.yml.
export NO_MKDOCS_2_WARNING=1
if [ "${1:-}" = --serve ]; then exec "$tools/mkdocs" serve; fi

# This runs without --quiet, because --strict ignores warnings with it.
log=$("$tools/mkdocs" build --strict --clean 2>&1) || { printf '%s\n' "$log" >&2; exit 1; }
# Links that a reader follows may lead anywhere; resources of the page may not.
loaded='<(script|img|iframe|source|link)[^>]*(src|href)="?(https?:)?//[^>]*>'
if grep -rnoE --include='*.html' "$loaded" target/book | grep -v 'rel="\?canonical'; then
    echo "book: these are loaded from the network" >&2
    exit 1
fi
echo "book: $(find target/book -name '*.html' | wc -l) pages, target/book/index.html"
