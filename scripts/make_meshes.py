#!/usr/bin/env python3
"""Writes the meshes of examples/meshes, our own geometry, lengths in mm.

    pip install gmsh==4.15.2 numpy        (gmsh also needs the system library libGLU: apt install libglu1-mesa)
    python scripts/make_meshes.py [FOLDER]

The same version of Gmsh writes the same files every time: one thread, fixed seed, coordinates rounded to 1e-6 mm.
"""
import pathlib
import sys

import gmsh
import numpy as np

from box_meshes import boxes, write_vtk

# Finger: a profile in the x-z plane, extruded along y. x = 0 at the base, the spine is at the bottom (low z), the ribs
# stand on it and are open at the top, towards which a cable through them bends the finger.
WIDTH = 15.0  # along y and along z
BASE = 15.0  # length of the base block
TIP = 85.0  # where the tip block begins
LENGTH = 95.0
SPINE = 4.5  # thickness
BEVEL = 5.0  # of the upper edge of the tip
RIBS = 4
GAP_FOOT, GAP_TOP = 5.0, 8.0  # width of a gap at the spine and at the top

# Trunk: a zigzag profile in the x-z plane, turned about z.
TRUNK_LENGTH = 195.0
RADIUS_BASE, RADIUS_TIP = 16.0, 8.0
GROOVES = 13
GROOVE_DEPTH = 0.10  # of the local radius


def finger_profile():
    """Corners (x, z), counter-clockwise."""
    low, high, foot = -WIDTH / 2, WIDTH / 2, -WIDTH / 2 + SPINE
    corners = [(0.0, low), (LENGTH, low), (LENGTH, high - BEVEL), (LENGTH - BEVEL, high)]
    for middle in np.flip(gap_middles()):
        corners += [(middle + GAP_TOP / 2, high), (middle + GAP_FOOT / 2, foot)]
        corners += [(middle - GAP_FOOT / 2, foot), (middle - GAP_TOP / 2, high)]
    return corners + [(0.0, high)]


def gap_middles():
    """x of the gaps: one before each rib and one before the tip block."""
    return BASE + (TIP - BASE) * (np.arange(RIBS + 1) + 0.5) / (RIBS + 1)


def finger():
    occ = gmsh.model.occ
    points = [occ.addPoint(x, -WIDTH / 2, z) for x, z in finger_profile()]
    lines = [occ.addLine(points[i - 1], points[i]) for i in range(len(points))]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    occ.extrude([(2, face)], 0, WIDTH, 0)
    occ.synchronize()
    size(lambda x, y, z: 10.0)


def trunk():
    occ = gmsh.model.occ
    corners = [(0.0, 0.0)]
    for i in range(2 * GROOVES + 1):
        z = TRUNK_LENGTH * i / (2 * GROOVES)
        radius = RADIUS_BASE + (RADIUS_TIP - RADIUS_BASE) * z / TRUNK_LENGTH
        corners.append((radius * (1 - GROOVE_DEPTH * (i % 2)), z))
    corners.append((0.0, TRUNK_LENGTH))
    points = [occ.addPoint(x, 0, z) for x, z in corners]
    lines = [occ.addLine(points[i - 1], points[i]) for i in range(len(points))]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, 2 * np.pi)
    occ.synchronize()
    size(lambda x, y, z: 0.55 * (RADIUS_BASE + (RADIUS_TIP - RADIUS_BASE) * z / TRUNK_LENGTH))


def size(wanted):
    """Element size [mm] as a function of the place."""
    for option in ("MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)
    gmsh.model.mesh.setSizeCallback(lambda dim, tag, x, y, z, lc: wanted(x, y, z))


def tetrahedra():
    """Nodes (n x 3) and tetrahedra (m x 4, 0-based) of the current model; nodes that no tetrahedron uses are dropped."""
    gmsh.model.mesh.generate(3)
    for _ in range(3):
        gmsh.model.mesh.optimize("Netgen")
        gmsh.model.mesh.optimize("")
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, cells = gmsh.model.mesh.getElementsByType(4)
    used, cells = np.unique(cells, return_inverse=True)
    place = {tag: i for i, tag in enumerate(tags)}
    nodes = coordinates.reshape(-1, 3)[[place[tag] for tag in used]]
    return np.round(nodes, 6) + 0.0, cells.reshape(-1, 4)


def block():
    """A block of 60 x 20 x 20 mm in 12 x 4 x 4 cells of six tetrahedra, without Gmsh."""
    return boxes(np.array([12, 4, 4]), np.array([60.0, 20.0, 20.0]), lambda x, y, z: True)


def chambers():
    """A bar of 60 x 16 x 16 mm in 10 x 4 x 4 cells with three closed chambers of 12 x 8 x 8 mm, the root at x = 0."""
    nodes, cells = boxes(
        np.array([10, 4, 4]), np.array([60.0, 16.0, 16.0]),
        lambda x, y, z: x % 3 == 0 or not (1 <= y <= 2 and 1 <= z <= 2),
    )
    used, cells = np.unique(cells, return_inverse=True)
    nodes, cells = nodes[used] - [0, 8, 8], cells.reshape(-1, 4)
    faces = np.concatenate([cells[:, [0, 2, 1]], cells[:, [0, 1, 3]], cells[:, [1, 2, 3]], cells[:, [0, 3, 2]]])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = faces[np.sort(first[count == 1])]
    at = nodes[outer]
    on = lambda axis, value: (np.abs(at[:, :, axis] - value) < 1e-9).all(axis=1)
    outside = on(0, 0) | on(0, 60) | on(1, -8) | on(1, 8) | on(2, -8) | on(2, 8)
    return nodes, cells, {"root": outer[on(0, 0)], "chambers": outer[~outside]}


def write_msh(path, nodes, cells, groups):
    """Gmsh 2.2 with a physical group for each list of triangles, and `body` for the tetrahedra."""
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n")
        names = [(2, name) for name in groups] + [(3, "body")]
        file.write(f"{len(names)}\n" + "".join(f'{dim} {k + 1} "{name}"\n' for k, (dim, name) in enumerate(names)))
        file.write(f"$EndPhysicalNames\n$Nodes\n{len(nodes)}\n")
        file.writelines(f"{i + 1} {x:g} {y:g} {z:g}\n" for i, (x, y, z) in enumerate(nodes))
        rows = [(2, k + 1, face) for k, faces in enumerate(groups.values()) for face in faces]
        rows += [(4, len(names), cell) for cell in cells]
        file.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for i, (kind, group, own) in enumerate(rows):
            file.write(f"{i + 1} {kind} 2 {group} {group} {' '.join(str(node + 1) for node in own)}\n")
        file.write("$EndElements\n")


def write_ring(path, ring, tube, around, across):
    """A ring about z as binary STL: middle of the tube on a circle of radius `ring`."""
    a, b = 2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(across) / across
    r = ring + tube * np.cos(b)
    points = np.stack([np.outer(np.cos(a), r), np.outer(np.sin(a), r), np.outer(np.ones(around), tube * np.sin(b))], axis=-1)
    next_a, next_b = np.roll(points, -1, axis=0), np.roll(points, -1, axis=1)
    both = np.roll(next_a, -1, axis=1)
    facets = np.stack([np.stack([points, next_a, both], axis=2), np.stack([points, both, next_b], axis=2)], axis=2)
    facets = facets.reshape(-1, 3, 3).astype("<f4")
    record = np.zeros(len(facets), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    record["corners"] = facets
    path.write_bytes(b"Sinew ring, mm".ljust(80) + np.uint32(len(facets)).tobytes() + record.tobytes())


def report(name, nodes, cells):
    corners = nodes[cells]
    a, b, c = (corners[:, k] - corners[:, 0] for k in (1, 2, 3))
    volumes = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    edges = sum(((corners[:, i] - corners[:, j]) ** 2).sum(axis=1) for i in range(4) for j in range(i))
    quality = 12 * np.cbrt(3 * volumes.clip(0)) ** 2 / edges
    print(
        f"{name}: {len(nodes)} nodes, {len(cells)} tetrahedra, volume {volumes.sum():.1f} mm^3, mean ratio worst "
        f"{quality.min():.3f}, mean {quality.mean():.3f}, box {nodes.min(axis=0)} to {nodes.max(axis=0)}"
    )


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent / "examples/meshes")
    folder.mkdir(parents=True, exist_ok=True)
    gmsh.initialize()
    for option, value in (("General.Terminal", 0), ("General.NumThreads", 1), ("Mesh.RandomSeed", 1)):
        gmsh.option.setNumber(option, value)
    for build, title in ((finger, "Sinew soft finger, mm"), (trunk, "Sinew soft trunk, mm")):
        gmsh.clear()
        gmsh.model.add(build.__name__)
        build()
        nodes, cells = tetrahedra()
        write_vtk(folder / f"{build.__name__}.vtk", title, nodes, cells)
        report(build.__name__, nodes, cells)
    gmsh.finalize()
    nodes, cells = block()
    write_vtk(folder / "block.vtk", "Sinew soft block, mm", nodes, cells)
    report("block", nodes, cells)
    nodes, cells, groups = chambers()
    write_msh(folder / "chambers.msh", nodes, cells, groups)
    report("chambers", nodes, cells)
    write_ring(folder / "ring.stl", 30, 5, 32, 12)


if __name__ == "__main__":
    main()
