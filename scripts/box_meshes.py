"""Meshes of boxes in tetrahedra, and their files; needs numpy alone."""
import numpy as np


def boxes(n, size, keep):
    """Nodes and tetrahedra of the boxes of a grid that are kept, six each."""
    k, j, i = np.meshgrid(*(np.arange(m + 1) for m in n[::-1]), indexing="ij")
    nodes = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1) / n * size
    number = lambda i, j, k: (k * (n[1] + 1) + j) * (n[0] + 1) + i
    cells = []
    for z in range(n[2]):
        for y in range(n[1]):
            for x in range(n[0]):
                if not keep(x, y, z):
                    continue
                corner = [number(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1)) for c in range(8)]
                ring = [1, 3, 2, 6, 4, 5, 1]  # around the diagonal from corner 0 to corner 7
                for a, b in zip(ring, ring[1:]):
                    cell = [corner[0], corner[a], corner[b], corner[7]]
                    edges = nodes[cell[1:]] - nodes[cell[0]]
                    cells.append(cell if np.linalg.det(edges) > 0 else [cell[0], cell[2], cell[1], cell[3]])
    return nodes, np.array(cells)


def write_vtk(path, title, nodes, cells):
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write(f"# vtk DataFile Version 2.0\n{title}\nASCII\nDATASET UNSTRUCTURED_GRID\n")
        file.write(f"POINTS {len(nodes)} double\n")
        file.writelines(" ".join(f"{x:.6f}".rstrip("0").rstrip(".") for x in node) + "\n" for node in nodes)
        file.write(f"CELLS {len(cells)} {5 * len(cells)}\n")
        file.writelines(f"4 {a} {b} {c} {d}\n" for a, b, c, d in cells)
        file.write(f"CELL_TYPES {len(cells)}\n" + "10\n" * len(cells))
