# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's lamps to the tracer's. Same watts, same picture as in Cycles (PHYSICS section 6b)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from opal_kernels.descriptions import Light, LightType, Ray

from ..finiteness import all_finite
from ..identity import Named

Report = Callable[..., None]  # `report.Report.add`

MOST_LINK_SETS = 64  # bits of opal_light_desc.receivers
EVERYTHING = (1 << MOST_LINK_SETS) - 1


def _ignore(*_what: Any) -> None:
    pass


def _no_spectra(_values: Any) -> int:
    return -1


def visibility(obj: Any) -> Ray:
    """The kinds of ray that see an object, from its ray visibility."""
    flags = (
        (obj.visible_camera, Ray.CAMERA),
        (obj.visible_diffuse, Ray.DIFFUSE),
        (obj.visible_glossy, Ray.GLOSSY),
        (obj.visible_transmission, Ray.TRANSMISSION),
        (obj.visible_volume_scatter, Ray.SCATTER),
        (obj.visible_shadow, Ray.SHADOW),
    )
    return Ray(sum(ray for seen, ray in flags if seen))


def _point(data: Any) -> dict[str, Any]:
    return {
        "type": LightType.POINT,
        "radius": data.shadow_soft_size,
        "soft_falloff": int(data.use_soft_falloff),
    }


def _spot(data: Any) -> dict[str, Any]:
    return _point(data) | {
        "type": LightType.SPOT,
        "spot_angle": data.spot_size,
        "spot_blend": data.spot_blend,
    }


def _sun(data: Any) -> dict[str, Any]:
    return {"type": LightType.SUN, "radius": 0.5 * data.angle}


def _area(data: Any) -> dict[str, Any]:
    round_shape = data.shape in {"DISK", "ELLIPSE"}
    return {
        "type": LightType.ELLIPSE if round_shape else LightType.RECTANGLE,
        "size_u": data.size,
        "size_v": data.size_y if data.shape in {"RECTANGLE", "ELLIPSE"} else data.size,
        "spread": data.spread,
    }


# One reader a lamp type; what it returns are fields of Light.
READERS: dict[str, Callable[[Any], dict[str, Any]]] = {
    "POINT": _point,
    "SPOT": _spot,
    "SUN": _sun,
    "AREA": _area,
}


def lamp_spectrum(data: Any) -> Any:
    """Relative spectral power of a lamp at 360 ... 830 nm; None for the light that its colour says."""
    settings = data.opal
    if settings.spectrum == "COLOR":
        return None
    from opal_kernels.optics import illuminants

    if settings.spectrum == "BLACKBODY":
        return illuminants.blackbody(settings.temperature)
    if settings.spectrum == "LASER":
        return illuminants.line(settings.laser_wavelength)
    return illuminants.lamp(settings.spectrum)


def out_of_range(data: Any, first: float, last: float) -> str:
    """One sentence where a lamp of lines has none among the wavelengths (nm) that are rendered; else empty."""
    lines = {"LASER": data.opal.laser_wavelength, "SODIUM": 589.3}
    nm = lines.get(data.opal.spectrum)
    if nm is None or first <= nm <= last:
        return ""
    return f"its light of {nm:.1f} nm lies outside of the {first:.0f} to {last:.0f} nm that the scene renders"


def lamp_color(data: Any) -> tuple[float, float, float]:
    """The tint of a lamp, linear Rec.709: a blackbody of luminance 1 times the colour; the colour alone beside a spectrum."""
    tint = tuple(data.color)
    if getattr(data, "use_temperature", False) and data.opal.spectrum == "COLOR":
        tint = tuple(t * c for t, c in zip(tint, data.temperature_color, strict=True))
    return tint


def node_factor(data: Any, context: Any, report: Report) -> tuple[float, float, float]:
    """What a lamp's node tree makes of it: strength times colour of its Emission, (1, 1, 1) without nodes."""
    if not data.use_nodes or data.node_tree is None or context is None:
        return (1.0, 1.0, 1.0)
    from ..nodes import (
        compile_light_nodes,
    )  # the node readers are only loaded for a render

    factor, problems = compile_light_nodes(data, context)
    for problem in problems:
        report(Named(data), problem.message, f"node “{problem.node}”" if problem.node else "", problem.lost)
    return tuple(factor)


def light_from_object(
    obj: Any,
    *,
    matrix: Any = None,
    receivers: int = EVERYTHING,
    context: Any = None,
    report: Report = _ignore,
    add_spectrum: Callable[[Any], int] = _no_spectra,
) -> Light | None:
    """One lamp.

    Parameters
    ----------
    obj : bpy.types.Object
        Evaluated object of type LIGHT.
    matrix : Matrix, optional
        Object to world, for instances; the object's own by default.
    receivers : int
        Light linking, see `LightLinks`.
    context : optional
        Handed to the node readers; None leaves node trees unread.
    report : callable
        Takes a name and a sentence for what cannot be kept.
    add_spectrum : callable
        Takes relative spectral power at 360 ... 830 nm, returns its number in the scene.

    Returns
    -------
    Light or None
        None for what gives no light: portals, a power of zero.
    """
    data = obj.data
    reader = READERS.get(data.type)
    if reader is None:
        report(Named(obj), f"Opal has no lamps of type {data.type}: it is left out", "Type", True)
        return None
    settings = getattr(data, "cycles", None)
    if data.type == "AREA" and getattr(settings, "is_portal", False):
        return None
    linking = getattr(obj, "light_linking", None)
    if linking is not None and linking.blocker_collection is not None:
        report(Named(obj), "Opal has no shadow linking: everything casts this lamp's shadow", "Shadow Linking")
    factor = node_factor(data, context, report)
    color = tuple(c * f for c, f in zip(lamp_color(data), factor, strict=True))
    power = data.energy * 2.0 ** getattr(data, "exposure", 0.0)
    if power == 0.0 or not any(color):
        return None
    shape = reader(data)
    for part, values in (("Power", [power]), ("Color", color), ("Size", shape.values())):
        if not all_finite(values):
            report(Named(obj), f"the lamp is left out: its {part} is not finite", part, True)
            return None
    m = obj.matrix_world if matrix is None else matrix
    spectrum = lamp_spectrum(data)
    return Light(
        spectrum=-1 if spectrum is None else add_spectrum(spectrum),
        transform=[list(row) for row in m][:3],
        color=color,
        power=power,
        visibility=int(visibility(obj)),
        cast_shadow=int(data.use_shadow),
        normalize=int(getattr(data, "normalize", True)),
        receivers=receivers,
        **shape,
    )


class LightLinks:
    """Which lamps light which objects, as receiver sets.

    Objects that the same linked lamps light share a set. Ask for `group` of every object first, then for `receivers` of every
    lamp: a set is created when an object first needs it.

    Parameters
    ----------
    lamps : iterable of bpy.types.Object
        Every lamp of the scene; those without a receiver collection light everything.
    report : callable
        Told when there are more sets than the kernels can tell apart.
    """

    def __init__(self, lamps: Iterable[Any], report: Report = _ignore) -> None:
        self._rules: dict[str, Callable[[str], bool]] = {}
        for lamp in lamps:
            linking = getattr(lamp, "light_linking", None)
            collection = linking.receiver_collection if linking is not None else None
            if collection is not None:
                self._rules.setdefault(_identity(lamp), _rule(collection))
        self._sets: dict[tuple[bool, ...], int] = {}
        self._report = report

    def group(self, obj: Any) -> int:
        """The receiver set of an object; -1 where no lamp is linked, so that every lamp lights it."""
        if not self._rules:
            return -1
        lit = tuple(lights(_identity(obj)) for lights in self._rules.values())
        if lit not in self._sets and len(self._sets) == MOST_LINK_SETS:
            self._report(
                Named(obj),
                f"More than {MOST_LINK_SETS} combinations of light links: every lamp lights this object",
                "Light Linking",
            )
            return -1
        return self._sets.setdefault(lit, len(self._sets))

    def receivers(self, lamp: Any) -> int:
        """The sets that a lamp lights, one bit each."""
        name = _identity(lamp)
        if name not in self._rules:
            return EVERYTHING
        place = list(self._rules).index(name)
        return sum(1 << number for lit, number in self._sets.items() if lit[place])


def _identity(obj: Any) -> str:
    original = getattr(obj, "original", None)
    return (obj if original is None else original).name_full


def _rule(collection: Any) -> Callable[[str], bool]:
    """Whether the object of a name is lit: by a collection with included objects only those, else all but the excluded."""
    included: set[str] = set()
    excluded: set[str] = set()

    def visit(members: Any, inherited: str | None) -> None:
        for obj, link in zip(members.objects, members.collection_objects, strict=False):
            state = inherited or link.light_linking.link_state
            (included if state == "INCLUDE" else excluded).add(_identity(obj))
        for child, link in zip(members.children, members.collection_children, strict=False):
            visit(child, inherited or link.light_linking.link_state)

    visit(collection, None)
    return lambda name: name not in excluded and (not included or name in included)
