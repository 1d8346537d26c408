"""The one table of actions that menus, toolbar, shortcuts and palette are made from."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from crossview.cases.model import METHODS
from crossview.gui.actions import ActionSpec
from crossview.gui.window_verbs import WindowVerbs
from crossview.scene import LAYERS
from crossview.session.commands import METHOD_LABELS
from crossview.session.hand import OWN_TOOLS, SelectTool
from crossview.session.state import SessionState
from crossview.session.waypoints import NATURAL_LABELS
from crossview.view.scalars import SURFACE_SCALARS


def _locked(state: SessionState) -> bool:
    selected = state.focus.selected
    return selected is not None and state.singularities[selected].locked


def _open(state: SessionState) -> bool:
    return state.document is not None


def _clipped(state: SessionState) -> bool:
    return state.clip is not None


def _selected(state: SessionState) -> bool:
    return state.document is not None and state.focus.selected is not None


def _solvable(state: SessionState) -> bool:
    return state.document is not None and state.document.budget.satisfied


def _any_tool(verbs: WindowVerbs) -> None:
    verbs.session.pointer.take_tool(verbs.session.state.any_valence)


def _is_any(state: SessionState) -> bool:
    return state.added_valence is not None and state.added_valence not in OWN_TOOLS


def _paired(state: SessionState) -> bool:
    return state.document is not None and state.focus.pair is not None


def _incomplete(state: SessionState) -> bool:
    return state.document is not None and not state.document.budget.satisfied


def _placed(state: SessionState) -> bool:
    return state.document is not None and len(state.document.singularities) > 0


def _carried() -> tuple[ActionSpec, ...]:
    """Actions that mirror and turn a configuration."""
    verbs = (
        ("mirror", "Mirror across", "Mirror", "Put all singularities at their mirror images"),
        ("rotate", "Rotate 90° about", "Rotate", "Turn all singularities about the middle"),
    )
    return tuple(
        ActionSpec(
            f"{verb}-{name}",
            f"{title} {name}",
            "Singularities",
            lambda w, verb=verb, axis=axis: getattr(w.session.pairs, verb)(axis),  # type: ignore[misc]
            tip=tip,
            enabled=_placed,
            submenu=submenu,
        )
        for verb, title, submenu, tip in verbs
        for axis, name in enumerate("xyz")
    )


def _with_selected(verb: Callable[[WindowVerbs, int], None], verbs: WindowVerbs) -> None:
    index = verbs.session.state.focus.selected
    if index is not None:
        verb(verbs, index)


def _with_all(verbs: WindowVerbs) -> tuple[int, ...]:
    return verbs.session.state.focus.all


def _tools() -> tuple[ActionSpec, ...]:
    return tuple(
        ActionSpec(
            f"add-{valence}",
            f"Add valence {valence}",
            "Singularities",
            lambda w, valence=valence: w.session.pointer.take_tool(valence),  # type: ignore[misc]
            (str(valence),),
            f"valence:{valence}",
            f"Click on the surface places a valence {valence}; again or Esc ends",
            _open,
            lambda state, valence=valence: state.added_valence == valence,  # type: ignore[misc]
        )
        for valence in OWN_TOOLS
    )


def _movable(state: SessionState) -> bool:
    """Whether the budget holds, some defect is not 0, and it is not being mended."""
    return state.defects is not None and not state.valid and state.moving is None


def _improvable(state: SessionState) -> bool:
    """Whether the budget holds, some singularity may move, and none is on its way."""
    document = state.document
    if document is None or not document.budget.satisfied or state.moving is not None:
        return False
    return any(s.index and not s.locked for s in document.singularities)


def _simplifiable(state: SessionState) -> bool:
    """Whether besides merging may leave fewer singularities."""
    document = state.document
    return (
        _improvable(state)
        and document is not None
        and (document.fewest < len(document.singularities))
    )


def _connected(state: SessionState) -> bool:
    """Whether some singularities are to stay joined."""
    return state.document is not None and len(state.document.connections) > 0


def _naturals() -> tuple[ActionSpec, ...]:
    return tuple(
        ActionSpec(
            f"natural-{method}",
            label,
            "Singularities",
            lambda w, method=method: w.session.moves.place_natural(method),  # type: ignore[misc]
            tip="Replace the singularities by those that a smooth cross-field has by itself",
            enabled=_open,
            submenu="Natural singularities",
        )
        for method, label in NATURAL_LABELS.items()
    )


def _methods() -> tuple[ActionSpec, ...]:
    tips = {
        "isotropic": "One size at each place; follows every edit",
        "aligned": "Boundary-aligned with the singularities imposed, integrable or not",
        "anisotropic": "Two sizes, so that the aligned field becomes integrable",
        "alternating": "The paper's own iteration for two sizes; may stall",
    }
    return tuple(
        ActionSpec(
            f"method-{method}",
            METHOD_LABELS[method],
            "Solve",
            lambda w, method=method: w.session.edits.choose_method(method),  # type: ignore[misc]
            (f"Num+{key}",) if method != "alternating" else (),
            tip=tips[method],
            enabled=_open,
            checked=lambda s, method=method: s.method == method,  # type: ignore[misc]
            separated=method == METHODS[0],
        )
        for key, method in enumerate(METHODS, start=1)
    )


def _views() -> tuple[ActionSpec, ...]:
    views = (
        ("xz", "From the front"),
        ("zx", "From the back"),
        ("yz", "From the right"),
        ("zy", "From the left"),
        ("xy", "From above"),
        ("yx", "From below"),
        ("iso", "From a corner"),
    )
    return tuple(
        ActionSpec(
            f"view-{direction}",
            text,
            "View",
            lambda w, direction=direction: w.look_from(direction),  # type: ignore[misc]
            (f"Ctrl+{key}",),
            tip="Fill the window with the whole surface, seen from there",
            enabled=_open,
            submenu="Look",
        )
        for key, (direction, text) in enumerate(views, start=1)
    )


def _layers() -> tuple[ActionSpec, ...]:
    return tuple(
        ActionSpec(
            f"layer-{kind.name}",
            kind.label,
            "View",
            lambda w, name=kind.name: w.session.looks.toggle_layer(name),  # type: ignore[misc]
            tip=kind.tip,
            checked=lambda s, name=kind.name: s.layers[name].visible,  # type: ignore[misc]
            separated=kind is LAYERS[0],
            submenu="Colour by" if kind.name in SURFACE_SCALARS else "Layers",
        )
        for kind in LAYERS
    )


ACTIONS: tuple[ActionSpec, ...] = (
    ActionSpec(
        "open", "Open…", "File", lambda w: w.files.ask_open(), ("Ctrl+O",), "open",
        "Open a surface or a case",
    ),
    ActionSpec(
        "gallery", "Gallery…", "File", lambda w: w.show_gallery(), icon="gallery",
        tip="Cases that come with crossview, each with a picture and a sentence",
    ),
    ActionSpec(
        "save", "Save", "File", lambda w: w.files.save(), ("Ctrl+S",), "save",
        "Write the document to its project or case file", _open,
    ),
    ActionSpec(
        "save-as", "Save as…", "File", lambda w: w.files.ask_save(), ("Ctrl+Shift+S",),
        tip="Write a project, with layers, camera and ranges, or a case alone", enabled=_open,
    ),
    ActionSpec(
        "figure", "Figure…", "File", lambda w: w.files.ask_figure(), ("Ctrl+E",), "figure",
        "Write what is shown as PNG, SVG or PDF, with the settings of the Export panel", _open,
        separated=True,
    ),
    ActionSpec(
        "save-quads", "Save quads as…", "File", lambda w: w.files.ask_save_quads(),
        ("Ctrl+Alt+S",), "save", "Write the quad mesh as OBJ, VTK, VTU, PLY, GLTF or MSH",
        lambda s: s.made.quads is not None,
    ),
    ActionSpec(
        "quit", "Quit", "File", lambda w: w.close(), ("Ctrl+Q",), tip="Close the window",
        separated=True,
    ),
    ActionSpec(
        "undo", "Undo", "Edit", lambda w: w.session.edits.undo(), ("Ctrl+Z",), "undo",
        enabled=lambda s: s.undo_name is not None,
    ),
    ActionSpec(
        "redo", "Redo", "Edit", lambda w: w.session.edits.redo(), ("Ctrl+Shift+Z", "Ctrl+Y"),
        "redo", enabled=lambda s: s.redo_name is not None,
    ),
    ActionSpec(
        "copy-script", "Copy as Python", "Edit", lambda w: w.help.copy_script(),
        tip="A script that solves what is open and makes the quads shown", enabled=_open,
        separated=True,
    ),
    ActionSpec(
        "select-all", "Select all", "Edit", lambda w: w.session.pointer.select_all(),
        ("Ctrl+A",), tip="Select every singularity; Ctrl and a click adds one or takes one away, "
        "Ctrl and a drag those in a band. Arrow keys move what is selected, a drag of one all",
        enabled=_placed, separated=True,
    ),
    ActionSpec(
        "preferences", "Preferences…", "Edit", lambda w: w.appearance.show_dialog(), ("Ctrl+,",),
        tip="Theme, shading, copies of unsaved work, how many quads at first", separated=True,
    ),
    ActionSpec(
        "use-largest", "Use the largest piece", "Surface", lambda w: w.files.reopen("largest"),
        tip="Open the same again and keep its largest piece", enabled=_open,
    ),
    ActionSpec(
        "repair", "Repair", "Surface", lambda w: w.files.reopen(repair=True),
        tip="Open the same again; drop bad triangles, cut non-manifold places apart",
        enabled=_open,
    ),
    ActionSpec(
        "mark-edges", "Mark edges", "Surface", lambda w: w.session.feature_marks.take_tool(),
        ("M",), tip="A click marks an edge for the crosses to follow, or no longer; with Shift the "
        "shortest path from the last click",
        enabled=_open, checked=lambda s: s.mark_tool is not None, separated=True,
    ),
    ActionSpec(
        "clear-features", "Remove all features", "Surface",
        lambda w: w.session.feature_marks.clear(), tip="Mark no edge any more",
        enabled=lambda s: s.features is not None and len(s.features) > 0,
    ),
    ActionSpec(
        "select", "Select", "Singularities", lambda w: w.escape(),
        ("Esc",), "select", "Select and drag singularities; elsewhere turn the view",
        checked=lambda s: isinstance(s.tool, SelectTool),
    ),
    *_tools(),
    ActionSpec(
        "add-any", "Add any valence", "Singularities", _any_tool, ("N",), "valence:n",
        "Click on the surface places the valence chosen beside", _open, _is_any,
    ),
    ActionSpec(
        "edit", "Change valence…", "Singularities",
        partial(_with_selected, lambda w, i: w.edit_valence(i)),
        ("Return", "Enter"),
        tip="Type another valence; also a double click", enabled=_selected, separated=True,
    ),
    ActionSpec(
        "raise", "Raise valence", "Singularities",
        lambda w: w.session.edits.step_valence(1, *_with_all(w)), ("+", "="),
        "plus", "One more quad at each selected singularity; also the wheel over it", _selected,
    ),
    ActionSpec(
        "lower", "Lower valence", "Singularities",
        lambda w: w.session.edits.step_valence(-1, *_with_all(w)), ("-",), "minus",
        "One quad fewer at each selected singularity; also the wheel over it",
        _selected,
    ),
    ActionSpec(
        "lock", "Locked", "Singularities",
        lambda w: w.session.edits.toggle_lock(*_with_all(w)), ("L",), "lock",
        "Keep the selected singularities where they are", _selected,
        _locked,
    ),
    ActionSpec(
        "delete", "Delete", "Singularities",
        lambda w: w.session.edits.remove(*_with_all(w)), ("Del", "Backspace"),
        "trash", "Delete the selected singularities", _selected,
    ),
    ActionSpec(
        "clear", "Delete all", "Singularities",
        lambda w: w.session.edits.remove(*range(len(w.session.state.singularities))),
        tip="Delete every singularity", enabled=lambda s: len(s.singularities) > 0,
    ),
    ActionSpec(
        "add-pair", "Add a pair of 3 and 5", "Singularities", lambda w: w.add_pair(), ("P",),
        tip="Around the place under the mouse, else where there is most room; keeps the index sum",
        enabled=_open, separated=True,
    ),
    ActionSpec(
        "merge", "Merge the two selected", "Singularities",
        lambda w: w.session.pairs.merge(), ("J",),
        tip="One singularity of two; select the second with Ctrl and a click", enabled=_paired,
    ),
    ActionSpec(
        "split", "Split in two", "Singularities",
        partial(_with_selected, lambda w, i: w.session.pairs.split(i)), ("S",),
        tip="Two singularities of half the index, as two 5 of a 6", enabled=_selected,
    ),
    *_carried(),
    ActionSpec(
        "distribute", "Distribute the missing index", "Singularities",
        lambda w: w.session.pairs.distribute(),
        tip="Add the valences 3 or 5 that are missing, where they even out the sizes most",
        enabled=_incomplete,
    ),
    ActionSpec(
        "make-valid", "Make valid", "Singularities", lambda w: w.session.moves.make_valid(),
        tip="Move unlocked singularities as little as need be until every loop closes",
        enabled=_movable, separated=True,
    ),
    ActionSpec(
        "improve", "Improve", "Singularities", lambda w: w.session.moves.improve(),
        tip="Move unlocked singularities to where sizes are most even, every loop kept closed; "
        "stopped, they stay where they are",
        enabled=_improvable,
    ),
    ActionSpec(
        "snap", "Snap", "Singularities", lambda w: w.session.moves.snap(),
        tip="Move unlocked singularities a little, until separatrices meet those they nearly met, "
        "and keep them joined",
        enabled=_improvable,
    ),
    ActionSpec(
        "let-connections-go", "Let connections go", "Singularities",
        lambda w: w.session.moves.let_connections_go(),
        tip="Keep the selected singularities, or all if none is selected, joined no longer",
        enabled=_connected,
    ),
    ActionSpec(
        "simplify", "Simplify", "Singularities", lambda w: w.simplify(),
        tip="Merge unlocked singularities until as many are left as the Validity panel says, "
        "and make those valid",
        enabled=_simplifiable,
    ),
    *_naturals(),
    ActionSpec(
        "along-curvature", "Along curvature", "Singularities",
        lambda w: w.session.moves.toggle_along_curvature(),
        tip="Draw the crosses of natural singularities towards the directions of curvature",
        checked=lambda s: s.along_curvature, separated=True, submenu="Natural singularities",
    ),
    ActionSpec(
        "fewest-natural", "As few as may be", "Singularities",
        lambda w: w.session.moves.toggle_fewest_natural(),
        tip="Let natural singularities of opposite indices cancel, until the fewest are left",
        checked=lambda s: s.fewest_natural, submenu="Natural singularities",
    ),
    ActionSpec(
        "solve", "Solve", "Solve", lambda w: w.session.solving.solve(), ("F5",), "solve",
        "Solve again with refinement at the singularities", _solvable,
    ),
    ActionSpec(
        "mesh", "Make quads", "Solve", lambda w: w.make_quads(), ("F6", "Q"), "mesh",
        "Fill the surface with quads along the field, as the Quads panel says", _solvable,
    ),
    ActionSpec(
        "stop", "Stop", "Solve", lambda w: w.session.solving.stop(), ("Shift+F5",), "stop",
        "Stop the computation; the last field stays", lambda s: s.progress is not None,
    ),
    *_methods(),
    ActionSpec(
        "compare", "Compare with the start", "Solve", lambda w: w.session.looks.compare(), ("C",),
        tip="Show the error density that the method started from, on the range of the result",
        enabled=lambda s: s.start is not None,
        checked=lambda s: s.comparing and s.start is not None, separated=True,
    ),
    ActionSpec(
        "fit", "Fit to window", "View", lambda w: w.look_from("auto"), ("F",), "fit",
        "Show the whole surface", _open,
    ),
    *_views(),
    ActionSpec(
        "projection", "Perspective or parallel", "View", lambda w: w.change_projection(), ("O",),
        tip="Show in parallel what is shown in perspective, or the other way round",
        enabled=_open,
    ),
    ActionSpec(
        "clip", "Clip", "View", lambda w: w.toggle_clip(), ("X",),
        tip="Cut away the half nearer to the eye, to look inside; figures show all",
        enabled=_open, checked=lambda s: s.clip is not None, submenu="Clip",
    ),
    ActionSpec(
        "clip-less", "Clip less", "View", lambda w: w.session.looks.move_clip(1), ("PgUp",),
        tip="Move the plane that clips towards what it cuts away", enabled=_clipped,
        submenu="Clip",
    ),
    ActionSpec(
        "clip-more", "Clip more", "View", lambda w: w.session.looks.move_clip(-1), ("PgDown",),
        tip="Move the plane that clips away from what it cuts away", enabled=_clipped,
        submenu="Clip",
    ),
    ActionSpec(
        "measure", "Measure", "View", lambda w: w.session.measuring.take_tool(), ("D",),
        tip="Two clicks measure a distance, along the surface and straight; a third the angle at "
        "the second. A click on a singularity is one at its place",
        enabled=_open, checked=lambda s: s.measure_tool is not None, separated=True,
    ),
    ActionSpec(
        "copy-camera", "Copy camera", "View", lambda w: w.copy_camera(), ("Ctrl+Shift+C",),
        tip="As text for the command line, a script or another window", enabled=_open,
        separated=True,
    ),
    ActionSpec(
        "paste-camera", "Paste camera", "View", lambda w: w.paste_camera(), ("Ctrl+Shift+V",),
        tip="Look with the camera that was copied", enabled=_open,
    ),
    *_layers(),
    ActionSpec(
        "dark", "Dark scene", "View",
        lambda w: w.session.looks.toggle_dark(), checked=lambda s: s.dark,
        separated=True,
    ),
    ActionSpec(
        "reset-docks", "Reset panels", "View", lambda w: w.reset_docks(),
        tip="Put all panels back to where they stand at first", submenu="Panels",
    ),
    ActionSpec(
        "palette", "Command palette…", "Help", lambda w: w.show_palette(), ("Ctrl+Shift+P",),
        "search", "Find any action by name",
    ),
    ActionSpec(
        "tour", "Tour", "Help", lambda w: w.start_tour(),
        tip="What to do first, a step after the other, in one minute", separated=True,
    ),
    ActionSpec(
        "keys", "Keys", "Help", lambda w: w.help.show_keys(), ("F1",),
        tip="List all keys",
    ),
    ActionSpec(
        "diagnostics", "Copy diagnostics", "Help", lambda w: w.help.copy_diagnostics(),
        tip="Versions, machine, what is open and the message, for a report of trouble",
    ),
    ActionSpec(
        "about", "About crossview", "Help", lambda w: w.help.show_about(), separated=True,
    ),
)  # fmt: skip
"""All actions: menus, toolbar, keys and palette are made from these."""

TOOLBAR: tuple[str, ...] = (
    "open", "|", "undo", "redo", "|", "select", "add-3", "add-5", "add-6", "add-8", "add-any",
    "any-valence", "|", "method", "solve-or-stop", "->", "fit", "figure", "mesh",
)  # fmt: skip
"""Names of actions; "|" is a line, "->" pushes the rest to the right."""

LABELLED = ("open", "figure", "mesh")
"""Actions of the toolbar with their words beside the icon."""
