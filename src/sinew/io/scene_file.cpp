#include "sinew/io/scene_file.hpp"

#include <fmt/core.h>

#include <utility>

#include "sinew/error/input_error.hpp"
#include "sinew/io/document.hpp"
#include "sinew/io/scene_fields.hpp"

namespace sinew::io {
namespace {

void collect_lines(std::map<std::string, int>& lines, const Node& node, const std::string& path) {
  const std::string prefix = path.empty() ? "" : path + ".";
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string here = prefix + std::to_string(i);
    lines[here] = node.items[i].line;
    collect_lines(lines, node.items[i], here);
  }
  for (const Entry& entry : node.entries) {
    lines[prefix + entry.key] = line_of(entry);
    collect_lines(lines, entry.value, prefix + entry.key);
  }
}

SceneFile scene_file(const Node& root, std::string text, const std::filesystem::path& name,
                     const std::filesystem::path& folder) {
  SceneFile file;
  file.scene = scene_type().read(At(root, name.string(), folder, &file.tables));
  file.scene.folder = folder.empty() ? "." : folder;
  file.text = std::move(text);
  file.path = name;
  collect_lines(file.lines, root, "");
  return file;
}

}  // namespace

SceneFile read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(read_text(file), file, file.parent_path(), overrides);
}

SceneFile parse_scene(const std::string& text, const std::filesystem::path& name, const std::filesystem::path& folder,
                      const std::vector<std::string>& overrides) {
  Node root = parse_document(text, name.string());
  if (root.kind == Node::Kind::map) {
    for (const std::string& assignment : overrides) set_value(root, assignment);
  }
  return scene_file(root, overrides.empty() ? text : write_document(root), name, folder);
}

SceneFile scene_of(const Node& tree, const std::filesystem::path& folder, const std::vector<std::string>& overrides) {
  Node root = tree;
  if (root.kind == Node::Kind::map) {
    for (const std::string& assignment : overrides) set_value(root, assignment);
  }
  const std::string text = write_document(root);
  if (text.size() > largest_document)
    throw InputError({.rule = fmt::format("the scene is longer than {} KiB when written down", largest_document / 1024),
                      .remedy = "put long tables into a file, `displacement: {file: pull.csv, column: x}`"});
  return scene_file(root, text, "", folder);
}

int line_of(const SceneFile& file, const std::string& field_path) {
  for (std::string path = field_path; !path.empty();) {
    if (const auto found = file.lines.find(path); found != file.lines.end()) return found->second;
    const std::size_t dot = path.rfind('.');
    path.resize(dot == std::string::npos ? 0 : dot);
  }
  return 0;
}

std::string scene_schema() {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Sinew scene"}};
  schema.update(scene_type().schema());
  schema["$defs"] = quantity_definitions();
  return schema.dump(2) + "\n";
}

}  // namespace sinew::io
