// Input files of Abaqus and CalculiX (.inp): nodes and elements, and sets and surfaces of them as groups. Materials,
// steps and loads are passed over. Formats: Abaqus Keywords Reference Guide (*NODE, *ELEMENT, *NSET, *ELSET, *SURFACE,
// *PART, *INSTANCE); CalculiX CrunchiX User's Manual, "Input deck format".
#include "sinew/io/mesh_abaqus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "sinew/io/abaqus_elements.hpp"
#include "sinew/io/mesh_formats.hpp"

namespace sinew::io {
namespace {

/// Numbers of the nodes or elements of a part, ascending, each with its index in the part.
class Numbering {
 public:
  Numbering(const AbaqusLines& lines, const std::vector<int>& numbers, const std::vector<std::size_t>& places,
            const char* what) {
    for (const int number : numbers) known_.push_back({number, static_cast<int>(known_.size())});
    std::stable_sort(known_.begin(), known_.end(), by_number);
    const auto twice = std::adjacent_find(known_.begin(), known_.end(),
                                          [](const Known& a, const Known& b) { return a.number == b.number; });
    if (twice != known_.end())
      lines.fail_at(places[static_cast<std::size_t>((twice + 1)->index)], std::to_string(twice->number),
                    fmt::format("two {} must not have the same number", what),
                    "if the file was joined from several, give each its own file, or number them anew");
  }

  std::size_t size() const { return known_.size(); }
  /// The index of a number, if it is there.
  std::optional<int> find(int number) const {
    const auto at = first_from(number);
    return at == known_.end() || at->number != number ? std::nullopt : std::optional(at->index);
  }
  /// Adds the indices of the numbers of a range that are there.
  void collect(const AbaqusMember& range, std::vector<int>& indices) const {
    for (auto at = first_from(range.first); at != known_.end() && at->number <= range.last; ++at)
      if ((at->number - range.first) % range.increment == 0) indices.push_back(at->index);
  }

 private:
  struct Known {
    int number, index;
  };
  static bool by_number(const Known& a, const Known& b) { return a.number < b.number; }
  std::vector<Known>::const_iterator first_from(int number) const {
    return std::lower_bound(known_.begin(), known_.end(), Known{number, 0}, by_number);
  }
  std::vector<Known> known_;
};

/// The sets of a part, and those of the assembly that name nodes or elements of it: by name, indices ascending.
struct Sets {
  std::map<int, std::vector<int>> of_part, of_assembly;
};

/// What becomes one group, or several if sets of nodes, sets of elements and surfaces of one name do not agree.
struct SameName {
  std::optional<solid::Group> nodes, elements, faces;
};

class AbaqusMesh {
 public:
  AbaqusMesh(AbaqusLines& lines, AbaqusContent& content)
      : lines_(lines),
        content_(content),
        number_(chosen_part()),
        part_(content.parts[static_cast<std::size_t>(number_)]),
        instance_(only_instance()),
        nodes_(lines, part_.node_numbers, part_.node_places, "nodes"),
        elements_(lines, part_.element_numbers, part_.element_places, "elements") {}

  solid::Mesh make() {
    mesh_.nodes = Eigen::Map<const Eigen::Matrix3Xd>(part_.coordinates.data(), 3, std::ssize(part_.coordinates) / 3);
    if (instance_) mesh_.nodes = (instance_->pose * mesh_.nodes).eval();
    mesh_.ignored = std::move(content_.ignored);
    mesh_.simplified = std::move(content_.simplified);
    resolve_sets();
    add_cells();
    add_groups();
    finish_cells(mesh_);
    return std::move(mesh_);
  }

 private:
  /// The one part that has cells.
  int chosen_part() {
    int chosen = -1;
    for (std::size_t i = 0; i < content_.parts.size(); ++i) {
      const AbaqusPart& part = content_.parts[i];
      const bool has_cells = std::any_of(part.elements.begin(), part.elements.end(), [](const AbaqusElement& element) {
        return element.kind && element.kind->role == Role::cell;
      });
      if (!has_cells) continue;
      if (chosen >= 0)
        lines_.fail_at(part.place, fmt::format("a second part with volume elements, {}", in_quotes(part.name)),
                       "a file must have one such part", "write each part to a file of its own: each is one solid");
      chosen = static_cast<int>(i);
    }
    if (chosen >= 0) return chosen;
    const auto with_nodes = std::find_if(content_.parts.begin(), content_.parts.end(),
                                         [](const AbaqusPart& p) { return !p.node_numbers.empty(); });
    if (with_nodes == content_.parts.end())
      lines_.fail("end of file", "the file must have nodes, after *NODE", "write the mesh again, with its nodes");
    return static_cast<int>(with_nodes - content_.parts.begin());
  }

  const AbaqusInstance* only_instance() {
    const AbaqusInstance* found = nullptr;
    for (const AbaqusInstance& instance : content_.instances) {
      if (instance.part != number_) continue;
      if (found)
        lines_.fail_at(instance.place, fmt::format("a second instance of part {}", in_quotes(part_.name)),
                       "a file must have one", "write the part by itself: a scene places each solid by its `pose`");
      found = &instance;
    }
    for (std::size_t i = 0; i < content_.parts.size(); ++i)
      if (const auto left_out = std::ssize(content_.parts[i].elements); static_cast<int>(i) != number_ && left_out > 0)
        content_.ignored["element of part " + in_quotes(content_.parts[i].name)] = static_cast<int>(left_out);
    return found;
  }

  std::span<const int> numbers_of(const AbaqusElement& element) const {
    return std::span(part_.element_nodes).subspan(element.first, element.last - element.first);
  }

  /// The nodes of an element, into `nodes`.
  void find_nodes(int index, std::vector<int>& nodes) const {
    nodes.clear();
    const auto element = static_cast<std::size_t>(index);
    for (const int number : numbers_of(part_.elements[element])) {
      const std::optional<int> node = nodes_.find(number);
      if (!node)
        lines_.fail_at(part_.element_places[element], fmt::format("node {}", number),
                       fmt::format("element {} must have nodes that are in the file", part_.element_numbers[element]),
                       "write the mesh again, with all its nodes");
      nodes.push_back(*node);
    }
  }

  /// A file of a few lines could name all nodes in each of them.
  void count_work(std::size_t more, std::size_t place) {
    work_ += more;
    if (work_ > 1000 * (nodes_.size() + elements_.size() + 1000))
      lines_.fail_at(place, "the sets of the file", "name each node and element a thousand times and more",
                     "leave out sets that nobody needs");
  }

  void resolve_sets() {
    for (const bool in_assembly : {false, true}) {
      const AbaqusPart& from = in_assembly ? content_.assembly : part_;
      for (const AbaqusSet& set : from.element_sets) resolve(set, elements_, element_sets_, in_assembly);
      for (const AbaqusSet& set : from.node_sets) resolve(set, nodes_, node_sets_, in_assembly);
    }
  }

  void resolve(const AbaqusSet& set, const Numbering& known, Sets& sets, bool in_assembly) {
    std::vector<int> found;
    std::vector<int> nodes;
    for (const AbaqusMember& member : set.members) {
      if (!set.of_elements) {
        collect(member, known, sets, set.place, found);
        continue;
      }
      std::vector<int> elements;
      collect(member, elements_, element_sets_, set.place, elements);
      for (const int element : elements) {
        find_nodes(element, nodes);
        found.insert(found.end(), nodes.begin(), nodes.end());
        count_work(nodes.size(), set.place);
      }
    }
    std::vector<int>& own = (in_assembly ? sets.of_assembly : sets.of_part)[set.name];
    own.insert(own.end(), found.begin(), found.end());
    solid::make_ascending(own);
    count_work(own.size(), set.place);
    if (set.internal) internal_.insert({in_assembly, set.name});
  }

  /// Adds the indices of what a member names. Numbers of the assembly are those of reference points, and members of
  /// other parts are not in the mesh.
  void collect(const AbaqusMember& member, const Numbering& known, const Sets& sets, std::size_t place,
               std::vector<int>& found) {
    if (member.part != number_ && (member.part != kAssembly || member.set < 0)) return;
    const std::size_t before = found.size();
    if (member.set >= 0) {
      const auto& own = member.part == kAssembly ? sets.of_assembly : sets.of_part;
      const auto at = own.find(member.set);
      if (at == own.end())
        lines_.fail_at(place, in_quotes(content_.names[static_cast<std::size_t>(member.set)]),
                       "there is no set of this name before it", "write the mesh again, with all its sets");
      found.insert(found.end(), at->second.begin(), at->second.end());
    } else {
      known.collect(member, found);
      if (member.first == member.last && found.size() == before)
        lines_.fail_at(place, std::to_string(member.first), "a set must name nodes and elements that are in the file",
                       "write the mesh again, with all its nodes and elements");
    }
    count_work(found.size() - before + 1, place);
  }

  /// Cells become cells of the mesh whether a set names them or not, other elements are kept in sets alone.
  void add_cells() {
    std::vector<char> in_set(part_.elements.size(), 0);
    for (const auto* sets : {&element_sets_.of_part, &element_sets_.of_assembly})
      for (const auto& [name, elements] : *sets)
        for (const int element : elements) in_set[static_cast<std::size_t>(element)] = 1;
    std::vector<int> nodes;
    cell_of_.assign(part_.elements.size(), -1);
    for (std::size_t i = 0; i < part_.elements.size(); ++i) {
      const FileKind* const kind = part_.elements[i].kind;
      if (!kind) continue;
      if (kind->role == Role::cell) {
        find_nodes(static_cast<int>(i), nodes);
        cell_of_[i] = static_cast<int>(mesh_.cells.size());
        add_cell(mesh_, *kind, nodes, {});
      } else if (!is_used(*kind, in_set[i] != 0)) {
        ++mesh_.ignored[kind->name];
      }
    }
  }

  void add_groups() {
    std::map<std::pair<bool, int>, SameName> all;  // by whether it is the assembly's, and its name
    const auto fill = [&](const Sets& sets, std::optional<solid::Group> SameName::*which, auto&& make_group) {
      for (const bool in_assembly : {false, true})
        for (const auto& [name, indices] : in_assembly ? sets.of_assembly : sets.of_part)
          if (!internal_.contains({in_assembly, name})) all[{in_assembly, name}].*which = make_group(indices);
    };
    fill(node_sets_, &SameName::nodes, [](const std::vector<int>& nodes) { return solid::Group{{}, {}, nodes}; });
    fill(element_sets_, &SameName::elements, [this](const std::vector<int>& elements) { return group_of(elements); });
    for (const bool in_assembly : {false, true})
      for (const AbaqusFacet& facet : (in_assembly ? content_.assembly : part_).facets) {
        std::optional<solid::Group>& faces = all[{in_assembly, facet.name}].faces;
        if (!faces) faces.emplace();
        add_facet(facet, *faces);
      }
    for (auto& [key, same] : all) {
      std::string name = content_.names[static_cast<std::size_t>(key.second)];
      // In an assembly a set of the part is named with its instance; here only where the assembly has one of that name.
      if (!key.first && all.contains({true, key.second}))
        name = (instance_ ? instance_->name : part_.name) + "." + name;
      add_group(name, same);
    }
  }

  void add_group(const std::string& name, SameName& same) {
    std::vector<std::pair<const char*, solid::Group*>> parts;
    for (const auto& [kind, group] :
         {std::pair{".nodes", &same.nodes}, {".elements", &same.elements}, {".faces", &same.faces}}) {
      if (!*group) continue;
      solid::make_ascending((*group)->nodes);
      if (!(*group)->nodes.empty()) parts.push_back({kind, &**group});
    }
    const bool agree = std::all_of(parts.begin(), parts.end(), [&parts](const auto& part) {
      return part.second->nodes == parts.front().second->nodes;
    });
    for (const auto& [kind, group] : parts) {
      solid::Group& made = mesh_.groups[agree ? name : name + kind];
      made.cells.insert(made.cells.end(), group->cells.begin(), group->cells.end());
      made.faces.insert(made.faces.end(), group->faces.begin(), group->faces.end());
      made.nodes.insert(made.nodes.end(), group->nodes.begin(), group->nodes.end());
    }
  }

  /// Of elements of kinds that are used: cells, and faces of shells.
  solid::Group group_of(const std::vector<int>& elements) {
    solid::Group group;
    std::vector<int> nodes;
    for (const int index : elements) {
      const FileKind* const kind = part_.elements[static_cast<std::size_t>(index)].kind;
      if (!kind || !is_used(*kind, true)) continue;
      find_nodes(index, nodes);
      if (const int cell = cell_of_[static_cast<std::size_t>(index)]; cell >= 0) group.cells.push_back(cell);
      if (kind->role == Role::face) group.faces.push_back(*abaqus_face(*kind, nodes, ""));
      group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
      count_work(nodes.size(), part_.element_places[static_cast<std::size_t>(index)]);
    }
    return group;
  }

  void add_facet(const AbaqusFacet& facet, solid::Group& group) {
    std::vector<int> members;
    if (facet.of_nodes) return collect(facet.member, nodes_, node_sets_, facet.place, group.nodes);
    collect(facet.member, elements_, element_sets_, facet.place, members);
    for (const int element : members) add_faces(element, facet, group);
  }

  /// The face of this name; without one, those on the boundary of the mesh.
  void add_faces(int index, const AbaqusFacet& facet, solid::Group& group) {
    const FileKind* const kind = part_.elements[static_cast<std::size_t>(index)].kind;
    if (!kind || !is_used(*kind, true)) return;
    std::vector<int> nodes;
    find_nodes(index, nodes);
    const auto add = [&](const solid::CellFace& face) {
      group.faces.push_back(face);
      group.nodes.insert(group.nodes.end(), face.nodes().begin(), face.nodes().end());
    };
    count_work(nodes.size(), facet.place);
    if (kind->role == Role::cell && facet.face.empty()) {
      for (const char* name : {"S1", "S2", "S3", "S4", "S5", "S6"})
        if (const auto face = abaqus_face(*kind, nodes, name); face && is_on_boundary(*face)) add(*face);
    } else if (const auto face = abaqus_face(*kind, nodes, facet.face)) {
      add(*face);
    } else {
      ++mesh_.ignored["face of a surface"];
    }
  }

  using Corners = std::vector<int>;
  static Corners corners_of(const solid::CellFace& face) {
    Corners corners(face.corners().begin(), face.corners().end());
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  bool is_on_boundary(const solid::CellFace& face) {
    if (boundary_.empty()) {
      for (const solid::CellFace& outer : solid::boundary(mesh_.cells)) boundary_.push_back(corners_of(outer));
      std::sort(boundary_.begin(), boundary_.end());
    }
    return std::binary_search(boundary_.begin(), boundary_.end(), corners_of(face));
  }

  AbaqusLines& lines_;
  AbaqusContent& content_;
  int number_;  // of the part
  const AbaqusPart& part_;
  const AbaqusInstance* instance_;
  Numbering nodes_, elements_;
  Sets node_sets_, element_sets_;
  std::set<std::pair<bool, int>> internal_;
  std::vector<int> cell_of_;  // per element: its number in the mesh
  std::vector<Corners> boundary_;
  solid::Mesh mesh_;
  std::size_t work_ = 0;
};

}  // namespace

solid::Mesh parse_abaqus(std::string_view bytes, const std::string& file) {
  AbaqusLines lines(bytes, file);
  AbaqusContent content = read_abaqus_content(lines);
  return AbaqusMesh(lines, content).make();
}

}  // namespace sinew::io
