"""A scene without a file: a clamped bar of one's own mesh sags under its weight, as beam theory says it does."""

import numpy as np

import sinew

length, side, young, density, g = 0.2, 0.02, 2e6, 1000.0, 9.81

bar = sinew.Solid(
    mesh=sinew.Mesh.bar((length, side, side), (80, 8, 8)),
    material=sinew.SolidMaterial(law="neo_hookean", young=young, poisson=0.0),
    density=density,
    fixed=sinew.Held(group="start"),
)
scene = sinew.Scene(
    analysis="static",
    gravity=[0, 0, -g / 20],  # a twentieth: beam theory is for small deflections
    solids={"bar": bar},
    outputs={"end": sinew.Output(solid="bar", point=[length, 0, 0])},
)
sag = -sinew.simulate(scene).state().output("end")[2]

area, inertia = side**2, side**4 / 12
load = density * area * g / 20
bending = load * length**4 / (8 * young * inertia)
shear = load * length**2 / (2 * (5 / 6) * (young / 2) * area)  # Timoshenko
print(f"sag {1e3 * sag:.4f} mm, beam theory {1e3 * (bending + shear):.4f} mm")
assert np.isclose(sag, bending + shear, rtol=0.015)
