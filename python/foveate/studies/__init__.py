# SPDX-License-Identifier: MIT OR Apache-2.0
"""Studies that train networks: what a network loses if it sees regions instead of whole images.

``python -m foveate.studies accuracy`` repeats the paper's study of accuracy, ``python -m foveate.studies savings`` compares accuracy
with bytes and MACs. Needs the extra ``studies``: ``torch`` and ``matplotlib``, for large networks ``torchvision``, for counts of MACs
``onnx``, for pictures ``pillow``.
"""
