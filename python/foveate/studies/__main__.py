# SPDX-License-Identifier: MIT OR Apache-2.0
"""``python -m foveate.studies``: the studies as commands."""
from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from foveate._extras import require_packages
from foveate.studies.data import SETS, StudyError

if TYPE_CHECKING:
    from foveate.studies.runs import RunFolder


def main(arguments: list[str] | None = None) -> int:
    """Run a study with the words of a command line. Return the exit code."""
    options = _parser().parse_args(arguments)
    try:
        _check_options(options)
        _check_packages(options)
        return _run(options)
    except (StudyError, ImportError, OSError) as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"interrupted: the runs below {options.output / 'runs'} are complete; the same command continues from there", file=sys.stderr)
        return 130


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m foveate.studies", description="Studies that train networks on what region cameras send.")
    studies = parser.add_subparsers(dest="study", required=True)
    accuracy = studies.add_parser("accuracy", help="accuracy of networks that learn from regions, beside originals")
    savings = studies.add_parser("savings", help="accuracy against bytes and MACs, over thresholds and region sizes")
    for study in (accuracy, savings):
        study.add_argument("-o", "--output", type=Path, required=True,
                           help="folder of runs, tables and figures; the same command continues an interrupted study")
        study.add_argument("--data", type=Path, default=os.environ.get("FOVEATE_DATA"),
                         help="folder of the sets: IDX files or torchvision's layout; default $FOVEATE_DATA; nothing is downloaded")
        study.add_argument("--sets", nargs="+", default=list(SETS), help=f"{', '.join(SETS)} or pictures (DATA/train/CLASS/*, DATA/test/CLASS/*)")
        study.add_argument("--epochs", type=int, default=3)
        study.add_argument("--batch", type=int, default=64)
        study.add_argument("--rate", type=float, default=0.001, help="rate of Adam at the start; it falls to 0 (default 0.001)")
        study.add_argument("--validation", type=int, default=5000,
                           help="images at the end of the training images, to choose thresholds (default 5000)")
        study.add_argument("--limit", type=float, default=1.0, help="share of every part of the sets, 0 to 1")
        study.add_argument("--model", default="lenet5", help="lenet5, resnet18, resnet50 or vgg16")
        study.add_argument("--size", type=int, help="scale images to this width and height")
        study.add_argument("--weights", type=Path, help="state_dict of torchvision's network to start from")
        study.add_argument("--device", default="cpu", help="cpu or cuda")
        study.add_argument("--jobs", type=int, default=1, help="parallel runs, each on one thread; Ctrl-C waits until those that have begun end")
    accuracy.add_argument("--thresholds", type=int, nargs="+", default=list(range(1, 11)), help="min_score of edge (default 1 to 10)")
    accuracy.add_argument("--seeds", type=int, default=10, help="seeds of the originals and of the chosen threshold (default 10)")
    accuracy.add_argument("--figure-seeds", type=int, default=3, help="seeds of every threshold (default 3)")
    accuracy.add_argument("--margin", type=float, default=0.2,
                          help="points of validation accuracy that the chosen threshold may lose (default 0.2)")
    savings.add_argument("--sizes", type=int, nargs="+", default=[4, 7, 8, 14], help="sizes of regions")
    savings.add_argument("--thresholds", type=int, nargs="+", default=[1, 2, 5, 10], help="min_score of edge")
    savings.add_argument("--seeds", type=int, default=3, help="networks that learn from originals and are tested on every camera (default 3)")
    savings.add_argument("--learned", type=int, default=1, help="number of these seeds that also learn from the regions of every camera (default 1)")
    savings.add_argument("--images", type=int, default=1000, help="test images on which MACs are counted (default 1000)")
    return parser


def _check_options(options: argparse.Namespace) -> None:
    """Raise an error for values that no study can use."""
    if options.data is None:
        raise StudyError("--data is missing: give the folder of the sets, or name it in FOVEATE_DATA")
    for name in ("epochs", "batch", "validation", "jobs", "seeds", "figure_seeds", "size"):
        value = getattr(options, name, None)
        if value is not None and value < 1:
            raise StudyError(f"--{name.replace('_', '-')} {value}: expected 1 or more")
    if not 0 < options.limit <= 1:
        raise StudyError(f"--limit {options.limit}: expected a share above 0 and up to 1")
    if options.rate <= 0:
        raise StudyError(f"--rate {options.rate}: expected a number above 0")
    if min(options.thresholds) < 1:
        raise StudyError(f"--thresholds {min(options.thresholds)}: expected 1 or more")


def _check_packages(options: argparse.Namespace) -> None:
    """Raise an error if a package is missing that is needed only hours later."""
    packages = {
        "torch": True,
        "matplotlib": True,
        "onnx": options.study == "savings",
        "torchvision": options.model != "lenet5",
        "PIL": "pictures" in options.sets,
    }
    require_packages("foveate.studies", [name for name, is_needed in packages.items() if is_needed], "studies")


def _run(options: argparse.Namespace) -> int:
    # --help must be fast, and torch takes seconds to load.
    from foveate.studies.runs import RunFolder, Settings
    from foveate.studies.training import check_device

    check_device(options.device)
    settings = Settings(
        model=options.model, size=options.size, device=options.device, epochs=options.epochs, batch=options.batch, rate=options.rate,
        validation=options.validation, limit=options.limit, weights=None if options.weights is None else str(options.weights))
    run_folder = RunFolder(options.output, options.data, settings, alone=len(options.sets) == 1)
    return _accuracy(run_folder, options) if options.study == "accuracy" else _savings(run_folder, options)


def _accuracy(run_folder: RunFolder, options: argparse.Namespace) -> int:
    from foveate.studies import plots, tables
    from foveate.studies.accuracy import Plan, runs_of, study

    plan = Plan(options.sets, sorted(set(options.thresholds)), options.seeds, options.figure_seeds, options.margin / 100)
    summary = study(run_folder, plan, jobs=options.jobs, report=_print_progress)
    text = tables.accuracy_markdown(summary)
    tables.write_all(options.output / "accuracy", runs_of(run_folder, plan, summary), summary, text)
    plots.accuracy(summary, options.output)
    print(text, end="")
    return 0


def _savings(run_folder: RunFolder, options: argparse.Namespace) -> int:
    from foveate.studies import plots, tables
    from foveate.studies.savings import Plan, study

    plan = Plan(options.sets, options.sizes, sorted(set(options.thresholds)), options.seeds, options.learned, options.images)
    summary = study(run_folder, plan, jobs=options.jobs, report=_print_progress)
    text = tables.savings_markdown(summary)
    tables.write_all(options.output / "savings", summary["rows"], summary, text)
    plots.savings(summary, options.output)
    print(text, end="")
    return 0


def _print_progress(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
