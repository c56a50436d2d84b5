# SPDX-License-Identifier: MIT OR Apache-2.0
"""Signatures name every parameter with its default, and stubs and docstrings have the same; every attribute is documented."""
import ast
import inspect
import re

import pytest

import foveate as fv
from conftest import ROOT, stub_of_the_compiled_part
from foveate import _foveate

#: The parameters of this method are the registers of a core, whose names depend on the design.
BY_NAME = {"Registers.set"}


def public(thing):
    """Returns the names of the public attributes that a class itself defines."""
    bases = [base for base in type.mro(thing) if base.__module__.startswith("foveate")]
    return sorted({name for base in bases for name in vars(base) if not name.startswith("_")})


def classes():
    return {name: thing for name in fv.__all__ if inspect.isclass(thing := getattr(fv, name)) and not issubclass(thing, Exception)}


def made():
    """Returns the classes that users instantiate."""
    return {name: classes()[name] for name in ("Camera", "TimedCamera", "Design", "Registers")}


def callables():
    """Returns every public function, method and class that users call, by name."""
    found = {name: getattr(fv, name) for name in fv.__all__ if inspect.isroutine(getattr(fv, name))}
    found |= made()
    for name, thing in classes().items():
        methods = [method for method in public(thing) if inspect.isroutine(getattr(thing, method))]
        found |= {f"{name}.{method}": getattr(thing, method) for method in methods if name not in ("Register", "RegisterField")}
    return found


def parameters(thing):
    return {name: one for name, one in inspect.signature(thing).parameters.items() if name != "self"}


def test_there_is_something_to_test():
    methods = {"Camera.step", "Camera.run", "Outcome.packets", "Design.generate", "Inference.table", "Registers.over_serial"}
    assert {"simulate", "infer", "Camera", "decode", "pixel_events", *methods} <= set(callables())


@pytest.mark.parametrize("name", sorted(callables()))
def test_a_signature_names_its_parameters(name):
    for own in parameters(callables()[name]).values():
        assert own.kind not in (own.VAR_KEYWORD, own.VAR_POSITIONAL) or name in BY_NAME | {"Registers.clear"}, f"{name}({own})"


@pytest.mark.parametrize("name", sorted(callables()))
def test_a_docstring_has_the_parameters_of_the_signature(name):
    text = inspect.getdoc(callables()[name])
    assert text, name
    if "Parameters\n----------" not in text:
        # The function of this name has the docstring.
        assert len(parameters(callables()[name])) < 1 or "see `foveate." in text or name in BY_NAME | {"Registers.clear", "Inference.table"}, name
        return
    section = text.split("Parameters\n----------\n")[1]
    section = re.split(r"\n\n\w[^\n]*\n-+\n", section)[0]
    named = [one for line in section.splitlines() if re.match(r"\w", line) for one in re.split(r", ", line.split(" : ")[0])]
    assert sorted(named) == sorted(parameters(callables()[name])), name


def stub():
    """Returns the parameters with defaults of the functions, methods and classes of the compiled part in the stub."""
    found = {}
    for node in stub_of_the_compiled_part().body:
        for one in node.body if isinstance(node, ast.ClassDef) else [node]:
            if not isinstance(one, ast.FunctionDef) or any("property" in ast.unparse(mark) for mark in one.decorator_list):
                continue
            owner = f"{node.name}." if isinstance(node, ast.ClassDef) else ""
            name = owner[:-1] if one.name == "__new__" else owner + one.name
            given = [*one.args.posonlyargs, *one.args.args]
            defaults = dict(zip([arg.arg for arg in given[::-1]], one.args.defaults[::-1], strict=False))
            defaults |= {arg.arg: value for arg, value in zip(one.args.kwonlyargs, one.args.kw_defaults, strict=True) if value is not None}
            names = [arg.arg for arg in [*given, *one.args.kwonlyargs] if arg.arg not in ("self", "cls")]
            found[name] = {name: ast.unparse(defaults[name]) if name in defaults else "" for name in names}
    return found


def test_stubs_have_the_parameters_and_defaults_of_signatures():
    compared = 0
    for name, own in stub().items():
        owner = name.split(".")[0]
        # Other functions are internal ones of the Python files.
        if name not in callables() or getattr(_foveate, owner) is not getattr(fv, owner):
            continue
        seen = {key: "" if one.default is one.empty else repr(one.default) for key, one in parameters(callables()[name]).items()}
        assert own == seen, name
        compared += 1
    assert compared >= 12


@pytest.mark.parametrize("name", sorted(classes()))
def test_every_attribute_has_its_documentation(name):
    attributes = public(classes()[name])
    for attribute in attributes:
        text = getattr(classes()[name], attribute).__doc__
        assert text and "Alias for field" not in text, f"{name}.{attribute}"


def test_arrays_say_their_type_and_their_shape():
    shared = ("srs", "trs", "active", "action", "changed", "scores", "displacements", "rendered")
    for owner, names in ((fv.Outcome, (*shared, "frame")), (fv.DecodedFrame, shared), (fv.ClipOutcome, (*shared, "time_us", "sent_bytes"))):
        for name in names:
            text = getattr(owner, name).__doc__
            assert re.search(r"array of (bool|uint8|int8|int64)", text) and "shape (" in text, name


def test_an_instance_has_no_attribute_without_documentation():
    errors = fv.fidelity("scene:street", max_frames=2)
    network = fv.infer(ROOT / "networks/denoiser.onnx", "scene:street", max_frames=2)
    for thing in (errors, network, fv.explain("scene:street")):
        assert not [name for name in vars(thing) if not name.startswith("_")], thing
    assert errors.problem is None and network.folder.is_dir() and network.summary["frames"] == 2
