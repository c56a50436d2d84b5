#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds the book (docs/, mkdocs.yml) into target/book and fails on a broken link, a missing anchor, a page that the contents
# do not list, and anything that a reader's browser would load from the network. MkDocs comes from PyPI, see python_tools.sh.
#
#   scripts/book.sh            then open target/book/index.html
#   scripts/book.sh --serve    at http://127.0.0.1:8000, built anew when a page changes
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
'' | --serve) ;;
*) echo "book: unknown option $1; see the head of scripts/book.sh" >&2 && exit 2 ;;
esac
tools=$(scripts/python_tools.sh --book)
# The live page, of which the tutorial has a frame. Git does not know it here.
"$(scripts/foveate.sh)" live --page docs/live.html
# The theme's note about its successor, which reads the same mkdocs.yml.
export NO_MKDOCS_2_WARNING=1
if [ "${1:-}" = --serve ]; then exec "$tools/mkdocs" serve; fi

# Without --quiet, under which --strict counts no warnings.
log=$("$tools/mkdocs" build --strict --clean 2>&1) || { printf '%s\n' "$log" >&2; exit 1; }
# Links that a reader follows may lead anywhere; what the page itself needs may not.
loaded='<(script|img|iframe|source|link)[^>]*(src|href)="?(https?:)?//[^>]*>'
if grep -rnoE --include='*.html' "$loaded" target/book | grep -v 'rel="\?canonical'; then
    echo "book: these are loaded from the network" >&2
    exit 1
fi
echo "book: $(find target/book -name '*.html' | wc -l) pages, target/book/index.html"
