// What an input file of Abaqus says of parts, instances and sets, before their numbers become those of a mesh.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "sinew/io/abaqus_lines.hpp"
#include "sinew/io/mesh_cells.hpp"

namespace sinew::io {

/// The assembly, where an index of a part is asked for. Its nodes are reference points with numbers of their own.
inline constexpr int kAssembly = -1;

struct AbaqusElement {
  const FileKind* kind;     ///< null: of a type that is not known
  std::size_t first, last;  ///< its nodes in AbaqusPart::element_nodes
};

/// What one entry of a set names: nodes or elements by number, or another set.
struct AbaqusMember {
  int part = 0;  ///< whose numbers and sets they are
  int first = 1, last = 0, increment = 1;
  int set = -1;  ///< its name, an index of AbaqusContent::names; negative: numbers
};

/// One block of a set; a set of several blocks has the members of all.
struct AbaqusSet {
  int name;  ///< in AbaqusContent::names
  std::size_t place;
  std::vector<AbaqusMember> members;
  bool of_elements = false;  ///< a set of nodes: its members are sets of elements, of which it has the nodes
  bool internal = false;     ///< made by the program, not by its user: it becomes no group
};

/// One line of a surface.
struct AbaqusFacet {
  int name;  ///< of the surface, in AbaqusContent::names
  std::size_t place;
  AbaqusMember member;
  std::string face;       ///< S1, ...; empty: those on the boundary
  bool of_nodes = false;  ///< the member is a set of nodes
};

struct AbaqusPart {
  std::string name;
  std::size_t place = 0;
  std::vector<int> node_numbers, element_numbers, element_nodes;
  std::vector<std::size_t> node_places, element_places;
  std::vector<double> coordinates;  ///< three per node
  std::vector<AbaqusElement> elements;
  std::vector<AbaqusSet> node_sets, element_sets;
  std::vector<AbaqusFacet> facets;
};

struct AbaqusInstance {
  std::string name;
  int part;
  std::size_t place;
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
};

struct AbaqusContent {
  std::vector<AbaqusPart> parts = {{}};  ///< the first has what the file says outside of parts
  AbaqusPart assembly;
  std::vector<AbaqusInstance> instances;
  std::vector<std::string> names;                  ///< of sets and surfaces, as they were first written
  std::map<std::string, int> ignored, simplified;  ///< as in solid::Mesh
};

AbaqusContent read_abaqus_content(AbaqusLines& lines);

}  // namespace sinew::io
