// The JSON Schema says what the reader does.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "full_scene.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/document.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {
namespace {

using Json = nlohmann::json;

SceneFile parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "finger.yaml", "scenes", overrides);
}

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

/// The keys that a document uses, written in the same way.
void collect(const Node& node, const std::string& path, std::set<std::string>& keys) {
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const Node& item : node.items) collect(item, prefix + "*", keys);
  const bool names = path == "frames" || path == "solids" || path == "rods" || path == "actuators" || path == "outputs";
  for (const Entry& entry : node.entries) {
    if (!names) keys.insert(prefix + entry.key);
    collect(entry.value, prefix + (names ? "*" : entry.key), keys);
  }
}

TEST(SceneSchema, ListsExactlyTheKeysOfTheReader) {
  const Json schema = Json::parse(scene_schema());
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  std::set<std::string> listed, read;
  collect(schema, "", listed);
  for (const char* text : {full_scene, other_scene}) {
    parse(text);  // so every key below is one the reader knows
    collect(parse_document(text, "scene"), "", read);
  }
  for (const std::string& key : listed) EXPECT_TRUE(read.contains(key)) << "no scene of this test uses " << key;
  for (const std::string& key : read) EXPECT_TRUE(listed.contains(key)) << "the schema lacks " << key;
  EXPECT_GT(listed.size(), 80u);

  // And the reader knows no more: a key that the schema does not list is refused in every object.
  std::set<std::string> objects;
  for (const std::string& key : listed) {
    const std::size_t dot = key.rfind('.');
    objects.insert(dot == std::string::npos ? "" : key.substr(0, dot + 1));
  }
  const std::map<std::string, std::string> names = {
      {"frames", "hand"}, {"solids", "finger"}, {"rods", "cable"}, {"actuators", "pull"}, {"outputs", "tip"}};
  for (std::string object : objects) {
    for (std::size_t star = object.find('*'); star != std::string::npos; star = object.find('*')) {
      const auto name = names.find(object.substr(0, star - 1));
      object.replace(star, 1, name == names.end() ? "0" : name->second);
    }
    // Where `finger` or `pull` has another alternative, somebody else in the two scenes has this one.
    const std::map<std::string, std::string> elsewhere = {{"solids.finger.fixed.0.", "solids.block.fixed.0."},
                                                          {"actuators.pull.force.", "actuators.push.force."},
                                                          {"actuators.pull.torque.", "actuators.turn.torque."},
                                                          {"actuators.pull.angle.", "actuators.bend.angle."}};
    const auto other = elsewhere.find(object);
    const std::string where = (other == elsewhere.end() ? object : other->second) + "zzz";
    const bool drives = where.starts_with("actuators.") && other != elsewhere.end();
    try {
      parse(drives ? other_scene : full_scene, {where + "=1"});
      ADD_FAILURE() << where << " is accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.fault().path, where);
      EXPECT_NE(error.fault().rule.find("is not a key of"), std::string::npos) << error.what();
    }
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
}

}  // namespace
}  // namespace sinew::io
