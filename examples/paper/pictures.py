"""Pictures of robots as the paper has them: seen from far away, bodies translucent, rods in the colours of what they bear."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib import colormaps
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import ListedColormap, Normalize, to_rgb

import sinew

Array = npt.NDArray[np.float64]
COLORS = ListedColormap(colormaps["turbo"](np.linspace(0.07, 0.93, 256)))  # blue: none, red: much


class View:
    """Axes in mm that show what lies in space, from the direction `toward`, with `up` pointing up."""

    def __init__(self, axes: Any, toward: npt.ArrayLike, up: npt.ArrayLike = (0.0, 1.0, 0.0)) -> None:
        to = np.asarray(toward, dtype=float) / np.linalg.norm(toward)
        right = np.cross(np.asarray(up, dtype=float), to)
        right /= np.linalg.norm(right)
        self.axes, self.toward = axes, to
        self.plane = np.stack([right, np.cross(to, right)])
        axes.set_aspect("equal")

    def flat(self, points: npt.ArrayLike) -> Array:
        """Points [m] on the picture [mm]. (..., 3) -> (..., 2)"""
        return np.asarray(1e3 * (np.asarray(points, dtype=float) @ self.plane.T))

    def surface(self, nodes: Array, triangles: npt.NDArray[np.int32], color: str, alpha: float) -> None:
        """The sides that look here, the farthest first, the darker the more they look away."""
        corners = nodes[triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        facing = normals @ self.toward / np.linalg.norm(normals, axis=1).clip(1e-30)
        order = np.argsort(corners.mean(axis=1) @ self.toward)
        order = order[facing[order] > 0.0]
        shade = 0.55 + 0.45 * facing[order, None]
        faces = PolyCollection(list(self.flat(corners[order])), facecolors=shade * np.array(to_rgb(color)), alpha=alpha, linewidths=0)
        self.axes.add_collection(faces)
        self.axes.autoscale_view()

    def solid(self, solid: sinew.SolidSnapshot, color: str = "#a9cce3", alpha: float = 0.5) -> None:
        self.surface(solid.nodes, solid.surface, color, alpha)

    def line(self, points: Array, values: Array, norm: Normalize, width: float = 4.0) -> LineCollection:
        """A curve in the colours of what it bears at its points."""
        flat = self.flat(points)
        parts = LineCollection(
            list(np.stack([flat[:-1], flat[1:]], axis=1)),
            array=0.5 * (values[:-1] + values[1:]),
            norm=norm,
            cmap=COLORS,
            linewidths=width,
            capstyle="round",
            zorder=3,
        )
        self.axes.add_collection(parts)
        self.axes.autoscale_view()
        return parts

    def balls(self, points: npt.ArrayLike, color: str, size: float = 7.0, label: str | None = None) -> None:
        x, y = self.flat(points).reshape(-1, 2).T
        self.axes.plot(x, y, "o", color=color, mec="black", mew=0.6, ms=size, zorder=4, label=label)
