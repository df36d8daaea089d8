// What can be seen of a state.
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "docs.hpp"
#include "engine.hpp"
#include "sinew/sim/view.hpp"

namespace sinew::python {

namespace {

using SnapshotPointer = std::shared_ptr<const Snapshot>;

/// A part of a snapshot, which it keeps.
template <class Part>
struct Seen {
  SnapshotPointer whole;
  const Part* part;
};
using SeenSolid = Seen<SolidSnapshot>;
using SeenRod = Seen<RodSnapshot>;
using SeenBody = Seen<BodySnapshot>;

template <class Part>
std::vector<Seen<Part>> all_of(const SnapshotPointer& whole, const std::vector<Part>& parts) {
  std::vector<Seen<Part>> all;
  for (const Part& part : parts) all.push_back({whole, &part});
  return all;
}

template <class Part>
nb::dict fields_of(const Seen<Part>& own) {
  nb::dict all;
  for (const Field& field : own.part->fields) {
    if (field.values.rows() == 1) {
      all[field.name.c_str()] = numbers_of(field.values.data(), field.values.size(), own.whole);
    } else {
      all[field.name.c_str()] = columns_of(field.values, own.whole);
    }
  }
  return all;
}

Whole triangles_of(const std::vector<solid::Triangle>& surface) {
  auto own = std::make_shared<std::vector<std::int32_t>>();
  for (const solid::Triangle& triangle : surface) {
    for (const int node : triangle) own->push_back(node);
  }
  return {{own->data(), {surface.size(), 3}, keep(own)}};
}

/// Nodes of the cells of each kind, under meshio's names, with the numbers of these cells.
nb::dict cells_of(const SeenSolid& seen) {
  constexpr std::pair<solid::Kind, const char*> kKinds[] = {
      {solid::Kind::tet4, "tetra"}, {solid::Kind::tet10, "tetra10"}, {solid::Kind::hex8, "hexahedron"}};
  nb::dict all;
  for (const auto& [kind, name] : kKinds) {
    auto own = std::make_shared<std::vector<std::int32_t>>();
    std::size_t count = 0;
    for (const solid::Cell& cell : seen.part->cells) {
      if (cell.kind != kind) continue;
      ++count;
      for (const int node : cell.nodes()) own->push_back(node);
    }
    if (count > 0) all[name] = Whole{{own->data(), {count, own->size() / count}, keep(own)}};
  }
  return all;
}

Rows rows_of(const std::vector<Eigen::Vector3d>& points) {
  auto own = std::make_shared<Eigen::Matrix3Xd>(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) own->col(static_cast<Eigen::Index>(i)) = points[i];
  return columns_of(*own, own);
}

nb::dict marks_of(const std::vector<MarkSnapshot>& marks) {
  nb::dict all;
  for (const MarkSnapshot& mark : marks)
    all[mark.name.c_str()] = vector_of(std::vector<double>(mark.position.begin(), mark.position.end()));
  return all;
}

template <class Part>
Numbers numbers(const Seen<Part>& own, const Eigen::VectorXd& values) {
  return numbers_of(values.data(), values.size(), own.whole);
}

}  // namespace

void bind_snapshots(nb::module_& module) {
  nb::class_<SeenSolid>(module, "SolidSnapshot", "A solid as it looks, with what its cells bear.")
      .def_prop_ro(
          "name", [](const SeenSolid& own) { return own.part->name; }, "As the scene calls it.")
      .def_prop_ro(
          "rest", [](const SeenSolid& own) { return columns_of(own.part->rest, own.whole); },
          "[m] positions of the nodes at t = 0, (nodes, 3).")
      .def_prop_ro(
          "nodes", [](const SeenSolid& own) { return columns_of(own.part->nodes, own.whole); },
          "[m] positions of the nodes now, (nodes, 3).")
      .def_prop_ro("cells", &cells_of, nb::sig("def cells(self) -> dict[str, numpy.typing.NDArray[numpy.int32]]"),
                   "Nodes of the cells of each kind, under meshio's names: {'tetra': (cells, 4), ...}.")
      .def_prop_ro(
          "surface", [](const SeenSolid& own) { return triangles_of(own.part->surface); },
          "Nodes of its boundary's triangles, looking outward, (triangles, 3).")
      .def_prop_ro(
          "von_mises", [](const SeenSolid& own) { return numbers(own, own.part->von_mises); },
          "[Pa] of each cell, in the order of the mesh, (cells,).")
      .def_prop_ro(
          "fields", [](const SeenSolid& own) { return fields_of(own); },
          nb::sig("def fields(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"), doc::SolidSnapshot_fields);
  nb::class_<SeenRod>(module, "RodSnapshot", doc::RodSnapshot)
      .def_prop_ro(
          "name", [](const SeenRod& own) { return own.part->name; }, "As the scene calls it.")
      .def_prop_ro(
          "abscissa", [](const SeenRod& own) { return numbers(own, own.part->abscissa); }, doc::RodSnapshot_abscissa)
      .def_prop_ro(
          "radius", [](const SeenRod& own) { return numbers(own, own.part->radius); }, doc::RodSnapshot_radius)
      .def_prop_ro(
          "points", [](const SeenRod& own) { return columns_of(own.part->points, own.whole); },
          "[m] of the centreline, (samples, 3).")
      .def_prop_ro(
          "tangents", [](const SeenRod& own) { return columns_of(own.part->tangents, own.whole); },
          "Unit tangents, (samples, 3).")
      .def_prop_ro(
          "von_mises", [](const SeenRod& own) { return numbers(own, own.part->von_mises); }, doc::RodSnapshot_von_mises)
      .def_prop_ro(
          "fields", [](const SeenRod& own) { return fields_of(own); },
          nb::sig("def fields(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"), doc::RodSnapshot_fields);
  nb::class_<SeenBody>(module, "BodySnapshot", doc::BodySnapshot)
      .def_prop_ro(
          "name", [](const SeenBody& own) { return own.part->name; }, "As the scene calls it.")
      .def_prop_ro(
          "points", [](const SeenBody& own) { return columns_of(own.part->points, own.whole); }, "[m] (points, 3).")
      .def_prop_ro(
          "surface", [](const SeenBody& own) { return triangles_of(own.part->surface); },
          "Points of its triangles, (triangles, 3).")
      .def_prop_ro(
          "ground", [](const SeenBody& own) { return own.part->ground; }, doc::BodySnapshot_ground);
  nb::class_<Snapshot>(module, "Snapshot",
                       "What can be seen of a state: positions, deformation and stress in the world.")
      .def_ro("time", &Snapshot::time, "[s]")
      .def_ro("when", &Snapshot::when, doc::Snapshot_when)
      .def_ro("status", &Snapshot::status, doc::Snapshot_status)
      .def_prop_ro(
          "solids", [](const SnapshotPointer& own) { return all_of(own, own->solids); }, "All solids.")
      .def_prop_ro(
          "rods", [](const SnapshotPointer& own) { return all_of(own, own->rods); }, "All rods and geometric cables.")
      .def_prop_ro(
          "bodies", [](const SnapshotPointer& own) { return all_of(own, own->bodies); },
          "All rigid bodies and obstacles.")
      .def_prop_ro(
          "contacts",
          [](const SnapshotPointer& own) {
            std::vector<Eigen::Vector3d> positions, forces;
            for (const ForceSnapshot& one : own->contacts) {
              positions.push_back(one.position);
              forces.push_back(one.force);
            }
            return nb::make_tuple(rows_of(positions), rows_of(forces));
          },
          nb::sig(
              "def contacts(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]"),
          "Points [m] and forces [N] where two touch, each (contacts, 3).")
      .def_prop_ro(
          "sliding_points",
          [](const SnapshotPointer& own) {
            std::vector<Eigen::Vector3d> positions;
            for (const MarkSnapshot& mark : own->sliding_points) positions.push_back(mark.position);
            return rows_of(positions);
          },
          "[m] of those that are on a rod, (points, 3).")
      .def_prop_ro(
          "outputs", [](const SnapshotPointer& own) { return marks_of(own->outputs); },
          nb::sig("def outputs(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
          "[m] where outputs are, by their names.");
}

}  // namespace sinew::python
