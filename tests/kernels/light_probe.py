# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks the light samplers and the camera single questions, through ``include/opal_test_lights.h``."""

import ctypes
from ctypes import POINTER, c_float, c_int32, c_int64, c_uint32

import numpy as np
from opal_kernels import binding
from opal_kernels.descriptions import Light, Program, World
from opal_kernels.scene import Scene

OP_COORDINATE, OP_EMISSION = 40, 88  # opal_shader.h
COORDINATE_POSITION = 4
EVERY_RAY = 63


class Receiver(ctypes.Structure):
    _fields_ = [
        ("position", c_float * 3),
        ("normal", c_float * 3),
        ("transmissive", c_int32),
        ("light_group", c_int32),
    ]


def receiver(position, normal=(0, 0, 0), transmissive=False, light_group=-1):
    return Receiver((c_float * 3)(*position), (c_float * 3)(*normal), int(transmissive), light_group)


def _floats(a):
    return a.ctypes.data_as(POINTER(c_float))


def _ints(a):
    return a.ctypes.data_as(POINTER(c_int32))


def _input(values, width):
    return np.ascontiguousarray(np.asarray(values, dtype=np.float32).reshape(-1, width))


def _call(name, *arguments):
    status = getattr(binding.library(), name)(*arguments)
    assert status == 0, f"{name} returned {status}"


def _handle(scene):
    return ctypes.c_void_p(scene.handle)


def emission_program(color, strength=1.0):
    """A program that emits one colour (in the world: radiates it)."""
    constants = np.array([[*color, 1.0], [strength] * 4], dtype=np.float32)
    code = np.full((1, 16), -1, dtype=np.int32)
    code[0, :3] = OP_EMISSION, 0, -1
    code[0, 4:6] = 0, 1
    return Program(code, constants, 2)


def direction_program(strength=1.0):
    """A world whose radiance in RGB is its direction's components (negative ones give nothing)."""
    code = np.full((2, 16), -1, dtype=np.int32)
    code[0, :3] = OP_COORDINATE, COORDINATE_POSITION, 1
    code[1, :3] = OP_EMISSION, 0, -1
    code[1, 4:6] = 1, 0
    return Program(code, np.array([[strength] * 4], dtype=np.float32), 2)


def scene_with(*lights, world=None, floor=False):
    """A committed scene; ``floor`` adds a black square of 20 m at z = -5, which gives the scene an extent."""
    scene = Scene(threads=1)
    if floor:
        mesh = scene.add_mesh(
            [[-10, -10, -5], [10, -10, -5], [10, 10, -5], [-10, 10, -5]],
            [[0, 1, 2], [0, 2, 3]],
        )
        scene.add_instances(mesh, [np.eye(4)])
    for light in lights:
        scene.add_light(light)
    if world is not None:
        scene.set_world(World(program=world) if isinstance(world, Program) else world)
    scene.commit()
    return scene


def numbers(n, dimensions, seed=1):
    """Well-spread numbers: a Kronecker sequence with the generalised golden ratio (Roberts 2018), shifted by the seed."""
    x = 1.5
    for _ in range(64):
        x = (1 + x) ** (1 / (dimensions + 1))
    steps = (1 / x) ** np.arange(1, dimensions + 1)
    start = np.random.default_rng(seed).random(dimensions)
    return ((start + np.arange(1, n + 1)[:, None] * steps) % 1.0).astype(np.float32).clip(0, 1 - 2**-24)


def sample_light(scene, where, u):
    u = _input(u, 3)
    n = len(u)
    out = {
        "direction": np.zeros((n, 3), np.float32),
        "distance": np.zeros(n, np.float32),
        "radiance": np.zeros((n, 3), np.float32),
        "pdf": np.zeros(n, np.float32),
        "dirac": np.zeros(n, np.int32),
        "source": np.zeros((n, 2), np.int32),
    }
    _call(
        "opal_test_sample_light", _handle(scene), ctypes.byref(where), c_int64(n), _floats(u), _floats(out["direction"]),
        _floats(out["distance"]), _floats(out["radiance"]), _floats(out["pdf"]), _ints(out["dirac"]), _ints(out["source"]),
    )  # fmt: skip
    return out


def light_pdf(scene, where, source, direction, distance):
    direction = _input(direction, 3)
    n = len(direction)
    source = np.ascontiguousarray(np.broadcast_to(np.asarray(source, np.int32), (n, 2)))
    distance = np.ascontiguousarray(np.broadcast_to(np.asarray(distance, np.float32), (n,)))
    pdf = np.zeros(n, np.float32)
    _call(
        "opal_test_light_pdf", _handle(scene), ctypes.byref(where), c_int64(n), _ints(source), _floats(direction),
        _floats(distance), _floats(pdf),
    )  # fmt: skip
    return pdf


def lights_along(scene, origin, direction, ray_kind=EVERY_RAY):
    direction = _input(direction, 3)
    n = len(direction)
    origin = np.ascontiguousarray(np.broadcast_to(np.asarray(origin, np.float32), (n, 3)))
    distance, radiance, source = (
        np.zeros(n, np.float32),
        np.zeros((n, 3), np.float32),
        np.zeros((n, 2), np.int32),
    )
    _call(
        "opal_test_lights_along", _handle(scene), c_int64(n), _floats(origin), _floats(direction), c_uint32(ray_kind),
        _floats(distance), _floats(radiance), _ints(source),
    )  # fmt: skip
    return distance, radiance, source


def sample_emission(scene, targets, u, probe=None):
    u = _input(u, 6)
    n = len(u)
    targets = _input(targets, 4) if len(targets) else np.zeros((0, 4), np.float32)
    probe = None if probe is None else _floats(np.asarray(probe, dtype=np.float32))
    origin, direction, flux = (np.zeros((n, 3), np.float32) for _ in range(3))
    source = np.zeros((n, 2), np.int32)
    _call(
        "opal_test_sample_emission", _handle(scene), c_int32(len(targets)), _floats(targets), c_int64(n), _floats(u), probe,
        _floats(origin), _floats(direction), _floats(flux), _ints(source),
    )  # fmt: skip
    return origin, direction, flux, source


def irradiance(scene, position, normal, n=20000, seed=1):
    """Irradiance at a point by sampling lights: mean of radiance x cosine / pdf, RGB, and its standard error."""
    s = sample_light(scene, receiver(position, normal), numbers(n, 3, seed))
    lit = s["pdf"] > 0
    cosine = np.clip(s["direction"] @ np.asarray(normal, np.float32), 0, None)
    value = np.zeros((n, 3))
    value[lit] = s["radiance"][lit] * (cosine / np.where(lit, s["pdf"], 1))[lit, None]
    return value.mean(axis=0), value.std(axis=0) / np.sqrt(n)


def looking(direction, position=(0, 0, 0), scale=(1, 1, 1)):
    """The 3 x 4 transform of a lamp at ``position`` whose -Z looks along ``direction``."""
    z = -np.asarray(direction, float) / np.linalg.norm(direction)
    x = np.cross([0.3, 1.0, 0.2], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x * scale[0], np.cross(z, x) * scale[1], z * scale[2], position])


def lamp(kind, position=(0, 0, 0), direction=(0, 0, -1), scale=(1, 1, 1), **fields):
    return Light(type=kind, transform=looking(direction, position, scale), **fields)
