#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "sinew/io/abaqus_elements.hpp"
#include "sinew/io/mesh_abaqus.hpp"

namespace sinew::io {
namespace {

constexpr const char* kWriteAll = "write the mesh from the program that made it to one file, with all its nodes";

class AbaqusReader {
 public:
  explicit AbaqusReader(AbaqusLines& lines) : lines_(lines) {}

  AbaqusContent read() {
    while (lines_.next()) {
      if (lines_.is_keyword()) read_block();  // data of blocks that are not read is passed over
    }
    return std::move(content_);
  }

 private:
  void read_block() {
    const std::size_t place = lines_.place();
    const Keyword keyword = lines_.keyword();
    const std::string& name = keyword.name;
    static const std::set<std::string> refused = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM"};
    if (refused.contains(name))
      lines_.fail_at(place, "*" + name, "nodes and elements that are made or moved by a rule are not read", kWriteAll);
    if (name == "INCLUDE" || ((name == "NODE" || name == "ELEMENT") && keyword.find("INPUT")))
      lines_.fail_at(place, "*" + name, "a mesh in several files is not read", kWriteAll);
    if (name == "NODE") return read_nodes(keyword, place);
    if (name == "ELEMENT") return read_elements(keyword, place);
    if (name == "NSET" || name == "ELSET") return read_set(keyword, place);
    if (name == "SURFACE") return read_surface(keyword);
    if (name == "PART") part_ = part_index(value_of(keyword, "NAME"), place);
    if (name == "INSTANCE") return read_instance(keyword, place);
    if (name == "END PART" || name == "END ASSEMBLY") part_ = 0;
    if (name == "ASSEMBLY" || name == "END INSTANCE") part_ = kAssembly;
  }

  /// Its nodes are reference points, its elements connect these: data that is passed over.
  bool in_assembly() const { return part_ == kAssembly; }

  AbaqusPart& part() { return in_assembly() ? content_.assembly : content_.parts[static_cast<std::size_t>(part_)]; }

  static std::string value_of(const Keyword& keyword, const char* parameter) {
    const std::string* const value = keyword.find(parameter);
    return value ? *value : "";
  }

  /// Of a part that is made when it is first named.
  int part_index(const std::string& name, std::size_t place) {
    const auto [at, is_new] = parts_.try_emplace(in_capitals(name), static_cast<int>(content_.parts.size()));
    if (is_new) {
      content_.parts.emplace_back();
      content_.parts.back().name = name;
      content_.parts.back().place = place;
    }
    return at->second;
  }

  /// Upper and lower case are the same.
  int name_index(std::string_view name) {
    const auto [at, is_new] = names_.try_emplace(in_capitals(name), static_cast<int>(content_.names.size()));
    if (is_new) content_.names.emplace_back(name);
    return at->second;
  }

  void read_nodes(const Keyword& keyword, std::size_t place) {
    if (const std::string system = value_of(keyword, "SYSTEM"); !system.empty() && in_capitals(system) != "R")
      lines_.fail_at(place, in_quotes("SYSTEM=" + system), "nodes must be in Cartesian coordinates", kWriteAll);
    const std::string set = value_of(keyword, "NSET");
    std::vector<AbaqusMember> members;
    while (!in_assembly() && lines_.next_data()) {
      std::vector<std::string_view> fields = lines_.fields();
      if (fields.size() < 2 || fields.size() > 7)  // behind the coordinates may follow a normal
        lines_.fail(in_quotes(lines_.text()), "a node must have its number and up to three coordinates",
                    "write it as in: 12, 0.5, 0, 1e-3");
      fields.resize(4);
      const int number = lines_.number(fields[0]);
      for (std::size_t axis = 1; axis <= 3; ++axis)
        part().coordinates.push_back(fields[axis].empty() ? 0.0 : lines_.coordinate(fields[axis]));
      part().node_numbers.push_back(number);
      part().node_places.push_back(lines_.place());
      if (!set.empty()) members.push_back({part_, number, number});
    }
    add_set(part().node_sets, set, place, std::move(members));
  }

  void read_elements(const Keyword& keyword, std::size_t place) {
    const std::string type = value_of(keyword, "TYPE"), set = value_of(keyword, "ELSET");
    if (type.empty())
      lines_.fail_at(place, "*ELEMENT", "must say of which type its elements are",
                     "write it as in: *ELEMENT, TYPE=C3D4");
    const FileKind* const kind = abaqus_kind(type);
    std::vector<AbaqusMember> members;
    while (!in_assembly() && lines_.next_data()) {
      const std::size_t start = lines_.place();
      const std::vector<int> numbers = kind ? read_numbers(kind->nodes) : std::vector{pass_over_element()};
      const auto nodes = static_cast<int>(numbers.size()) - 1;
      if (kind && kind->nodes > 0 && nodes != kind->nodes)
        lines_.fail_at(start, fmt::format("element {} with {} nodes", numbers[0], nodes),
                       fmt::format("an element of type {} must have {} nodes", in_quotes(type), kind->nodes),
                       "a line that goes on in the next one must end with a comma");
      if (!kind) ++content_.ignored["element of type " + in_quotes(type)];
      if (kind && is_simplified(*kind, type)) ++content_.simplified[in_capitals(type)];
      std::vector<int>& all = part().element_nodes;
      part().elements.push_back({kind, all.size(), all.size() + static_cast<std::size_t>(nodes)});
      all.insert(all.end(), numbers.begin() + 1, numbers.end());
      part().element_numbers.push_back(numbers[0]);
      part().element_places.push_back(start);
      if (!set.empty()) members.push_back({part_, numbers[0], numbers[0]});
    }
    add_set(part().element_sets, set, place, std::move(members));
  }

  /// The number of an element and those of its nodes: of this line and, as long as one ends with a comma and there are
  /// fewer than `nodes` (0: any number), of the next.
  std::vector<int> read_numbers(int nodes) {
    std::vector<int> numbers;
    while (true) {
      std::vector<std::string_view> fields = lines_.fields();
      const bool goes_on = fields.size() > 1 && fields.back().empty();
      if (goes_on) fields.pop_back();
      for (const std::string_view field : fields) numbers.push_back(lines_.number(field));
      if (!goes_on || (nodes > 0 && std::ssize(numbers) > nodes) || !lines_.next_data()) return numbers;
    }
  }

  /// Of a type that is not known; its number.
  int pass_over_element() {
    const int number = lines_.number(lines_.fields().front());
    while (lines_.text().ends_with(',') && lines_.next_data()) continue;
    return number;
  }

  void read_set(const Keyword& keyword, std::size_t place) {
    const bool of_nodes = keyword.name == "NSET";
    const std::string name = value_of(keyword, keyword.name.c_str());
    if (name.empty())
      lines_.fail_at(place, "*" + keyword.name, "a set must have a name",
                     fmt::format("write it as in: *{0}, {0}=tip", keyword.name));
    const std::string instance = value_of(keyword, "INSTANCE");
    const int owner = instance.empty() ? part_ : part_of_instance(instance, place);
    const bool by_rule = keyword.find("GENERATE") != nullptr;
    std::vector<AbaqusMember> members;
    while (lines_.next_data()) {
      std::vector<std::string_view> fields = lines_.fields();
      if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
      if (by_rule)
        members.push_back(range_of(fields, owner));
      else
        for (const std::string_view field : fields) members.push_back(member_of(field, owner));
    }
    std::vector<AbaqusSet>& sets = of_nodes ? part().node_sets : part().element_sets;
    // CAE marks what it has made for surfaces and picked by hand; nobody has named these.
    add_set(sets, name, place, std::move(members), keyword.find("INTERNAL") != nullptr);
    if (const std::string elements = value_of(keyword, "ELSET"); of_nodes && !elements.empty()) {
      add_set(sets, name, place, {member_of(elements, owner)});
      sets.back().of_elements = true;
    }
  }

  void add_set(std::vector<AbaqusSet>& sets, const std::string& name, std::size_t place,
               std::vector<AbaqusMember> members, bool internal = false) {
    if (name.empty()) return;
    sets.push_back({name_index(name), place, std::move(members)});
    sets.back().internal = internal;
  }

  AbaqusMember range_of(const std::vector<std::string_view>& fields, int owner) {
    if (fields.size() < 2 || fields.size() > 3)
      lines_.fail(in_quotes(lines_.text()), "a range must have its first and last number and an increment",
                  "write it as in: 1, 99, 2");
    return {owner, lines_.number(fields[0]), lines_.number(fields[1]),
            fields.size() == 3 ? lines_.number(fields[2]) : 1};
  }

  /// "12", "tip", or of an instance "arm-1.12" and "arm-1.tip".
  AbaqusMember member_of(std::string_view field, int owner) {
    for (std::size_t dot = field.find('.'); dot != std::string_view::npos; dot = field.find('.', dot + 1)) {
      const std::optional<int> found = instanced_part(without_quotes(field.substr(0, dot)));
      if (!found) continue;
      owner = *found;
      field = field.substr(dot + 1);
      break;
    }
    if (const std::optional<int> number = node_or_element_number(field)) return {owner, *number, *number};
    if (field.empty())
      lines_.fail(in_quotes(lines_.text()), "a number or a name must stand between two commas", kWriteAll);
    return {.part = owner, .set = name_index(without_quotes(field))};
  }

  /// The part of an instance, if there is one of this name.
  std::optional<int> instanced_part(std::string_view name) const {
    const auto at = instanced_parts_.find(in_capitals(name));
    return at == instanced_parts_.end() ? std::nullopt : std::optional(at->second);
  }

  int part_of_instance(const std::string& name, std::size_t place) const {
    const std::optional<int> found = instanced_part(name);
    if (!found)
      lines_.fail_at(place, in_quotes("INSTANCE=" + name), "there is no instance of this name before it", kWriteAll);
    return *found;
  }

  void read_surface(const Keyword& keyword) {
    const std::string name = value_of(keyword, "NAME"), type = in_capitals(value_of(keyword, "TYPE"));
    const bool is_read = !name.empty() && (type.empty() || type == "ELEMENT" || type == "NODE");
    const bool is_combined = keyword.find("COMBINE") != nullptr;
    if (!is_read || is_combined) {
      ++content_.ignored[is_combined ? "surface made of others" : "surface of another kind"];
      return;
    }
    while (lines_.next_data()) {
      const std::vector<std::string_view> fields = lines_.fields();
      const AbaqusMember everything = {part_, 1, std::numeric_limits<int>::max()};
      part().facets.push_back({name_index(name), lines_.place(),
                               fields[0].empty() ? everything : member_of(fields[0], part_),
                               type != "NODE" && fields.size() > 1 ? in_capitals(fields[1]) : "", type == "NODE"});
    }
  }

  /// Its data are a displacement, and a turn about the axis through two points by an angle in degrees.
  void read_instance(const Keyword& keyword, std::size_t place) {
    if (keyword.find("LIBRARY"))
      lines_.fail_at(place, "*INSTANCE", "an instance of the results of another analysis is not read", kWriteAll);
    std::array<double, 10> data{};
    std::size_t count = 0;
    while (lines_.next_data()) {
      for (const std::string_view field : lines_.fields()) {
        if (field.empty()) continue;
        if (count == data.size())
          lines_.fail(in_quotes(lines_.text()), "an instance is displaced by three numbers and turned by seven",
                      kWriteAll);
        data[count++] = lines_.coordinate(field);
      }
    }
    AbaqusInstance instance = {value_of(keyword, "NAME"), part_index(value_of(keyword, "PART"), place), place};
    instance.pose = Eigen::Translation3d(data[0], data[1], data[2]);
    const Eigen::Vector3d a(data[3], data[4], data[5]), axis = Eigen::Vector3d(data[6], data[7], data[8]) - a;
    if (axis.norm() > 0.0)
      instance.pose = Eigen::Translation3d(a) *
                      Eigen::AngleAxisd(data[9] * std::numbers::pi / 180.0, axis.stableNormalized()) *
                      Eigen::Translation3d(-a) * instance.pose;
    part_ = instance.part;  // nodes and elements may follow
    instanced_parts_.try_emplace(in_capitals(instance.name), instance.part);
    content_.instances.push_back(std::move(instance));
  }

  AbaqusLines& lines_;
  AbaqusContent content_;
  std::map<std::string, int> names_, parts_, instanced_parts_;  // by their names in capitals
  int part_ = 0;
};

}  // namespace

AbaqusContent read_abaqus_content(AbaqusLines& lines) { return AbaqusReader(lines).read(); }

}  // namespace sinew::io
