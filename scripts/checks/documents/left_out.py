# SPDX-License-Identifier: MIT OR Apache-2.0
"""The steps of pages that are not run, each with its reason. A step that is neither run nor listed here is an error, and so is an entry
without a step."""
from documents.run import LeftOut

PAGES = {"docs/commands.md": "it is made from the help texts, whose examples crates/cli/tests/cli/help.rs runs"}

DRAWING = "a drawing"
FORMULA = "a formula"
FOOTAGE = "it needs footage that is not shipped, and takes hours"
NETWORK = "it needs a network that is not shipped"
SETS = "it needs sets that are not shipped, and trains networks for an hour or more; python/tests trains small ones"
BOARD = "it needs a board"
VIVADO = "it needs Vivado"
SLURM = "it installs a cluster; scripts/slurm.sh and scripts/workflow.sh run it"
TOOLS = "it measures this machine or other programs, and needs networks or tools that are not shipped"
CHECKS = "scripts/release.sh runs it"
PYTORCH = "it needs PyTorch, a download of 5 GB"

NEVER = [
    ("README.md", "scripts/quickstart.sh", "scripts/release.sh runs it, in a release build"),
    ("docs/accelerators.md", "scripts/figures/compare_scalesim.py", TOOLS),
    ("docs/accuracy.md", "foveate explore approximations scene:street scene:night-rain $D", FOOTAGE),
    ("docs/accuracy.md", "foveate explore designs scene:street $D", FOOTAGE),
    ("docs/boards.md", "sensor -- DVP", DRAWING),
    ("docs/boards.md", "array_pattern --", DRAWING),
    ("docs/clock.md", "period = ", FORMULA),
    ("docs/guides/accuracy-study.md", "python -m foveate.studies", SETS),
    ("docs/guides/board.md", "openFPGALoader", BOARD),
    ("docs/guides/board.md", "foveate view /dev/ttyUSB1", BOARD),
    ("docs/guides/board.md", "stty -F /dev/ttyUSB1", BOARD),
    ("docs/guides/board.md", "foveate decode packets.bin", BOARD),
    ("docs/guides/board.md", "(cd array && vivado", VIVADO),
    ("docs/guides/choose.md", "xdg-open", "it opens a browser"),
    ("docs/guides/cluster.md", "python3 -m venv snakemake", SLURM),
    ("docs/guides/cluster.md", "snakemake/bin/pip install", SLURM),
    ("docs/guides/cluster.md", "snakemake --snakefile", SLURM),
    ("docs/guides/feature.md", "scripts/test.sh", "it runs this, too"),
    ("docs/guides/feature.md", "scripts/lint.sh", CHECKS),
    ("docs/guides/link.md", "foveate link $D", FOOTAGE),
    ("docs/guides/network.md", "foveate infer yolox_nano.onnx", NETWORK),
    ("docs/guides/network.md", "foveate fit street.mp4 --preset fovea --network yolox_nano.onnx", NETWORK),
    ("docs/guides/periphery.md", "foveate explore periphery $D", FOOTAGE),
    ("docs/guides/zones.md", "foveate simulate $D", "it needs footage that is not shipped"),
    ("docs/guides/zones.md", "scripts/figures/zones.py", "it needs footage and a network that are not shipped"),
    ("docs/guides/silicon.md", "foveate estimate --preset paper --liberty sky130hd", "it needs libraries that are not shipped"),
    ("docs/guides/silicon.md", "foveate estimate --preset raster --liberty", "it needs libraries that are not shipped"),
    ("docs/guides/python.md", "pip install .", "scripts/python.sh and scripts/artefacts.sh build and install the package"),
    ("docs/guides/python.md", "port = serial.Serial", BOARD),
    ("docs/guides/view.md", "foveate view out/packets.bin", "it ends at Ctrl-C; crates/cli/tests/cli/view.rs runs it"),
    ("docs/guides/view.md", "foveate view /dev/ttyUSB0", BOARD),
    ("docs/guides/view.md", "ssh -L", "it needs another machine"),
    ("docs/raster.md", "A = R*N*L", FORMULA),
    ("docs/savings.md", "clips=", FOOTAGE),
    ("docs/savings.md", "scripts/figures/savings.py", FOOTAGE),
    ("docs/savings.md", "foveate infer nets/resnet50.onnx $D", NETWORK),
    ("docs/savings.md", "scripts/figures/bench_networks.py", TOOLS),
    ("docs/savings.md", "cargo run --release", TOOLS),
    ("docs/speed.md", "FOVEATE_CACHE=off foveate bench", "it measures this machine for minutes; scripts/release.sh runs it"),
    ("docs/timing.md", "edge  ", DRAWING),
    ("docs/tutorial.md", "cargo install", "it installs into the home of who runs it; scripts/artefacts.sh does it elsewhere"),
]
# Steps that only `--whole` runs: they take long on a busy machine with two cores, or need a large download.
LONG = [
    ("docs/clock.md", "foveate estimate --preset bare --place-and-route", "two minutes"),
    ("docs/guides/board.md", "foveate build --board icebreaker", "four minutes"),
    ("docs/guides/board.md", "cp out/", "no time, but what the build wrote"),
    ("docs/guides/board.md", "foveate build --board my_board.toml", "a minute"),
    ("docs/guides/choose.md", "foveate fit", "three minutes"),
    ("docs/guides/choose.md", "foveate generate --config camera.toml", "no time, but what `fit` wrote"),
    ("docs/guides/choose.md", "foveate stress --config camera.toml", "no time, but what `fit` wrote"),
    ("docs/guides/choose.md", "foveate explore approximations street.mp4", "more than six minutes"),
    ("docs/guides/choose.md", "foveate explore space.toml", "minutes, which depend on what the command before it has kept"),
    ("docs/guides/data.md", "from foveate.torch import RegionEvents", PYTORCH),
    ("docs/guides/integrate.md", "sh core/synth/ecp5.sh", "a minute"),
    ("docs/guides/link.md", "foveate link scene:street", "a minute"),
    ("docs/guides/python.md", "import numpy as np\nimport torch", PYTORCH),
    ("docs/stress.md", "foveate stress --markdown", "two minutes"),
]

TABLE = [LeftOut(*entry) for entry in NEVER] + [LeftOut(*entry, is_long=True) for entry in LONG]
