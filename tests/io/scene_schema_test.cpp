// The JSON Schema says what the reader does.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "full_scene.hpp"
#include "parse.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/document.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {
namespace {

using Json = nlohmann::json;

/// A scene in which all that changes over time comes from a file, or a formula.
class TableFile {
 public:
  TableFile() : path_(std::filesystem::temp_directory_path() / ("sinew_table_" + std::to_string(getpid()) + ".csv")) {
    std::ofstream(path_) << "t,v\n0,1\n1,2\n";
  }
  ~TableFile() { std::filesystem::remove(path_); }
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  std::string scene() const {
    const std::string file = "{file: '" + path_.string() + "', column: v, time: t}",
                      files = "{file: '" + path_.string() + "', columns: [v, v, v], time: t}";
    std::string text = inverse_scene;
    const std::size_t from = text.find("actuators:"), to = text.find("outputs:"), targets = text.find("targets:");
    std::string moved = "actuators:\n", loads = "loads:\n";
    int count = 0;
    for (const std::string& drive : {file, std::string("{formula: 2 * t}")}) {
      for (const char* kind : {"force", "displacement", "torque", "angle"})
        moved += "  m" + std::to_string(++count) + ": {rod: cable, " + kind + ": " + drive + "}\n";
      moved += "  m" + std::to_string(++count) + ": {rod: cable, tendon: {distance: 1 mm}, tension: " + drive + "}\n";
      loads += "  l" + std::to_string(count) + ": {rod: cable, at: 10 mm, force: [1, 0, 0], factor: " + drive + "}\n";
    }
    return text.substr(0, from) + moved + loads + text.substr(to, targets - to) + "targets:\n  tip: {at: " + files +
           "}\n  nail: {at: {formula: [0, t, 0]}}\n  bend: {at: " + file + "}\n";
  }

 private:
  std::filesystem::path path_;
};

/// Paths of all keys that a schema lists; "*" for a name the user chooses and for the elements of a list.
void collect(const Json& schema, const std::string& path, std::set<std::string>& keys) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (schema.contains("properties")) {
    EXPECT_EQ(schema.at("additionalProperties"), false) << path;
    for (const auto& [key, value] : schema.at("properties").items()) {
      EXPECT_FALSE(value.at("description").get<std::string>().empty()) << prefix << key;
      keys.insert(prefix + key);
      collect(value, prefix + key, keys);
    }
  } else if (schema.contains("additionalProperties")) {
    collect(schema.at("additionalProperties"), prefix + "*", keys);
  }
  if (schema.contains("items")) collect(schema.at("items"), prefix + "*", keys);
  for (const Json& choice : schema.value("anyOf", Json::array())) collect(choice, path, keys);
}

/// The keys that a document uses, written in the same way, and of each map the place of one example.
struct Used {
  std::set<std::string> keys;
  std::map<std::string, std::string> places;  ///< "rods.*.section" to "rods.cable.section"
};

void collect(const Node& node, const std::string& path, const std::string& place, Used& used) {
  const auto below = [](const std::string& above, const std::string& key) {
    return above.empty() ? key : above + "." + key;
  };
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    collect(node.items[i], below(path, "*"), below(place, std::to_string(i)), used);
  }
  const std::set<std::string> of_names = {"frames",  "solids", "rods",      "actuators", "loads",
                                          "outputs", "bodies", "obstacles", "targets"};
  const bool names = of_names.contains(path);
  if (node.kind == Node::Kind::map && !names) used.places.emplace(path, place);
  for (const Entry& entry : node.entries) {
    if (!names) used.keys.insert(below(path, entry.key));
    collect(entry.value, below(path, names ? "*" : entry.key), below(place, entry.key), used);
  }
}

TEST(SceneSchema, ListsExactlyTheKeysOfTheReader) {
  const Json schema = Json::parse(scene_schema());
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  std::set<std::string> listed, read, refused;
  collect(schema, "", listed);
  const TableFile table;
  const std::string tables_scene = table.scene();
  for (const std::string& text : std::vector<std::string>{full_scene, rods_scene, solids_scene, bodies_scene,
                                                          other_scene, inverse_scene, tables_scene}) {
    parse(text);  // so every key below is one the reader knows
    Used used;
    collect(parse_document(text, "scene"), "", "", used);
    read.insert(used.keys.begin(), used.keys.end());

    // And the reader knows no more: a key that the schema does not list is refused in every object.
    for (const auto& [path, place] : used.places) {
      const std::string where = (place.empty() ? "" : place + ".") + "zzz";
      try {
        parse(text, {where + "=1"});
        ADD_FAILURE() << where << " is accepted";
      } catch (const InputError& error) {
        EXPECT_EQ(error.fault().path, where);
        EXPECT_NE(error.fault().rule.find("is not a key of"), std::string::npos) << error.what();
        refused.insert(path);
      }
    }
  }
  for (const std::string& key : listed) EXPECT_TRUE(read.contains(key)) << "no scene of this test uses " << key;
  for (const std::string& key : read) EXPECT_TRUE(listed.contains(key)) << "the schema lacks " << key;
  EXPECT_GT(listed.size(), 250u);
  for (const std::string& key : listed) {
    const std::size_t dot = key.rfind('.');
    EXPECT_TRUE(refused.contains(dot == std::string::npos ? "" : key.substr(0, dot))) << key;
  }
}

TEST(SceneSchema, ResolvesItsReferencesAndShowsDefaults) {
  const Json schema = Json::parse(scene_schema());
  std::function<void(const Json&)> walk = [&](const Json& json) {
    if (json.is_object() && json.contains("$ref")) {
      const std::string reference = json.at("$ref").get<std::string>();
      EXPECT_TRUE(schema.contains(Json::json_pointer(reference.substr(1)))) << reference;
    }
    if (json.is_structured()) {
      for (const Json& inner : json) walk(inner);
    }
  };
  walk(schema);
  EXPECT_EQ(schema.at("/properties/time/properties/step/default"_json_pointer), 0.01);
  const Json& solid = schema.at("/properties/solids/additionalProperties"_json_pointer);
  EXPECT_EQ(solid.at("required"), (Json{"mesh", "material"}));
  EXPECT_EQ(solid.at("/properties/material/properties/young/exclusiveMinimum"_json_pointer), 0.0);
  EXPECT_EQ(solid.at("/properties/material/properties/poisson/exclusiveMaximum"_json_pointer), 0.5);
  const Json& rod = schema.at("/properties/rods/additionalProperties/properties"_json_pointer);
  EXPECT_EQ(rod.at("/order/default"_json_pointer), 0);
  EXPECT_EQ(rod.at("/rest/default"_json_pointer), "path");
  EXPECT_EQ(rod.at("/base/default"_json_pointer), "clamped");
  const Json& coupling = schema.at("/properties/couplings/items"_json_pointer);
  EXPECT_EQ(coupling.at("/properties/tie/properties/along/default"_json_pointer), (Json{"x", "y", "z"}));
  EXPECT_EQ(coupling.at("/allOf/0/oneOf"_json_pointer),
            Json::parse(R"([{"required": ["slide"]}, {"required": ["tie"]}, {"required": ["glue"]}])"));
  EXPECT_EQ(schema.at("/properties/loads/additionalProperties/anyOf/0/properties/follower/examples/0"_json_pointer),
            true);
}

}  // namespace
}  // namespace sinew::io
