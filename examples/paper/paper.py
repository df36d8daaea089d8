"""What the scripts of this folder share: the public meshes, and motions without jumps."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import urllib.request
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from dossier import Result as Dossier  # noqa: E402

MESHES = {
    "finger.vtk": "1098e1eee95e412a34bd86839ab52863ecea1d3232a4bd79df8b4859d347d6f4",
    "trunk.vtk": "69ab9e47ddf701733f7020cc65991fe20bf2eed36f3d8fa8ebdb406a7c2b5fa6",
}
SOURCE = "https://raw.githubusercontent.com/SofaDefrost/SoftRobots/69d2b7b/docs/sofapython3/tutorials/{folder}/details/data/mesh/{name}"
FOLDERS = {"finger.vtk": "CableGripper", "trunk.vtk": "Trunk"}


def get_meshes() -> Path:
    """The folder that scenes here read the authors' finger and trunk from. They are not part of Sinew (LGPL): they are
    taken from SINEW_PAPER_MESHES, from ../shared/meshes beside the repository, or from where the authors keep them."""
    own = HERE / "meshes"
    own.mkdir(exist_ok=True)
    near = [Path(place) for place in [os.environ.get("SINEW_PAPER_MESHES", "")] if place]
    near.append(HERE.parents[2] / "shared" / "meshes")
    for name, digest in MESHES.items():
        if not (own / name).exists():
            found = next((folder / name for folder in near if (folder / name).exists()), None)
            if found:
                shutil.copyfile(found, own / name)
            else:
                address = SOURCE.format(folder=FOLDERS[name], name=name)
                try:
                    with urllib.request.urlopen(address, timeout=30) as answer:
                        (own / name).write_bytes(answer.read())
                except OSError as error:
                    raise SystemExit(
                        f"{name} cannot be fetched from {address} ({error}): get it from the SoftRobots plugin and set "
                        "SINEW_PAPER_MESHES to its folder"
                    ) from error
        if hashlib.sha256((own / name).read_bytes()).hexdigest() != digest:
            raise SystemExit(f"{own / name} is not the mesh of these results (another version?): remove it and try again")
    return own


class Result(Dossier):
    """A figure or table of the paper, whose scenes read the public meshes."""

    def __init__(self, script: str, title: str) -> None:
        super().__init__(script, title)
        get_meshes()


def smooth(u: float) -> float:
    """From 0 to 1, starting and ending at rest."""
    return u * u * u * (10.0 + u * (6.0 * u - 15.0))
