// What pages ask for, and what is none of it.
#include "sinew/live/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "sinew/error/input_error.hpp"
#include "sinew/runs/loaded_scene.hpp"

namespace sinew::live {
namespace {

const Model& robot() {
  static const runs::LoadedScene loaded = runs::load(io::read_scene(SINEW_SOURCE_DIR "/examples/reach.yaml"));
  return loaded.model;
}

template <class T>
T read(const std::string& text) {
  return std::get<T>(read_request(text, robot()));
}

std::string refusal(const std::string& text) {
  try {
    read_request(text, robot());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Request, EveryKindIsRead) {
  read<Play>(R"({"do": "play"})");
  read<Pause>(R"({"do": "pause"})");
  read<Step>(R"({"do": "step"})");
  read<Reset>(R"({"do": "reset"})");
  read<Release>(R"({"do": "release"})");
  EXPECT_EQ(read<Speed>(R"({"do": "speed", "value": 0.5})").value, 0.5);
  const Tell told = read<Tell>(R"({"do": "tell", "actuator": "pull_left", "value": 1.5})");
  EXPECT_EQ(robot().actuators[told.actuator].name, "pull_left");
  EXPECT_EQ(told.value, 1.5);
  EXPECT_EQ(read<Tell>(R"({"do": "tell", "actuator": "pull_left", "value": null})").value, std::nullopt);
  const Aim aim = read<Aim>(R"({"do": "aim", "target": "tip", "at": [1, 2, 3e-1]})");
  EXPECT_EQ(aim.effector, 0);
  EXPECT_EQ(*aim.at, Eigen::Vector3d(1, 2, 0.3));
  EXPECT_FALSE(read<Aim>(R"({"do": "aim", "target": "tip", "at": null})").at);
  const Grab grab = read<Grab>(R"({"do": "grip", "solid": "trunk", "node": 3, "to": [0, 0, 1], "stiffness": 20})");
  EXPECT_EQ(grab.grip.node, 3);
  EXPECT_EQ(grab.grip.stiffness, 20.0);
  EXPECT_EQ(grab.grip.to, Vec3(0, 0, 1));
  EXPECT_EQ(read<Seek>(R"({"do": "seek", "frame": 12})").frame, 12);
  EXPECT_EQ(read<Show>(R"({"do": "show", "solids": "von_mises", "rods": "", "energies": false})").solids,
            std::vector<std::string>{"von_mises"});
  EXPECT_EQ(read<Ack>(R"({"do": "ack", "frame": 7})").frame, 7);
}

TEST(Request, WhatIsNoneIsToldWhy) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal(""), HasSubstr("small JSON object"));
  EXPECT_THAT(refusal("[]"), HasSubstr("small JSON object"));
  EXPECT_THAT(refusal("{\"do\": \"\xff\"}"), HasSubstr("small JSON object"));
  EXPECT_THAT(refusal("{}"), HasSubstr("do: is missing"));
  EXPECT_THAT(refusal(R"({"do": "dance"})"), HasSubstr("not known"));
  EXPECT_THAT(refusal(R"({"do": 3})"), HasSubstr("must be text"));
  EXPECT_THAT(refusal(R"({"do": "tell", "actuator": "push", "value": 0})"), HasSubstr("does not exist"));
  EXPECT_THAT(refusal(R"({"do": "tell", "actuator": "pull_left"})"), HasSubstr("value: is missing"));
  EXPECT_THAT(refusal(R"({"do": "tell", "actuator": "pull_left", "value": 1e300})"), HasSubstr("1e12"));
  EXPECT_THAT(refusal(R"({"do": "tell", "actuator": "pull_left", "value": 1e999})"), HasSubstr("message"));
  EXPECT_THAT(refusal(R"({"do": "aim", "target": "tip", "at": [1, 2]})"), HasSubstr("3 numbers"));
  EXPECT_THAT(refusal(R"({"do": "grip", "solid": "trunk", "node": 1000000, "to": [0, 0, 0], "stiffness": 1})"),
              HasSubstr("does not exist in this solid"));
  EXPECT_THAT(refusal(R"({"do": "grip", "solid": "trunk", "node": -1, "to": [0, 0, 0], "stiffness": 1})"),
              HasSubstr("whole number"));
  EXPECT_THAT(refusal(R"({"do": "grip", "solid": "trunk", "node": 1, "to": [0, 0, 0], "stiffness": -1})"),
              HasSubstr("stiffness"));
  EXPECT_THAT(refusal(R"({"do": "seek", "frame": 1.5})"), HasSubstr("whole number"));
  EXPECT_THAT(refusal(R"({"do": "speed", "value": 0})"), HasSubstr("from 0.001"));
  EXPECT_THAT(refusal(R"({"do": "show", "solids": "beauty", "rods": "", "energies": false})"), HasSubstr("not known"));
  EXPECT_THAT(refusal(std::string(kLongestRequest + 1, ' ')), HasSubstr("bytes"));
  EXPECT_THAT(refusal("{\"do\": " + std::string(1000, '[') + std::string(1000, ']') + "}"), HasSubstr("JSON"));
}

TEST(Request, AnythingIsReadOrRefused) {
  const std::vector<std::string> seeds = {
      R"({"do": "tell", "actuator": "pull_left", "value": 1.5})",
      R"({"do": "aim", "target": "tip", "at": [1, 2, 3e-1]})",
      R"({"do": "grip", "solid": "trunk", "node": 3, "to": [0, 0, 1], "stiffness": 20})",
      R"({"do": "show", "solids": "von_mises", "rods": "bending", "energies": true})",
      R"({"do": "speed", "value": 0.5})",
  };
  std::mt19937 random(1);
  int taken = 0;
  for (int i = 0; i < 100000; ++i) {
    std::string text = seeds[random() % seeds.size()];
    for (auto k = random() % 4; k > 0; --k) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + random() % 5);
          break;
        default:
          text.insert(at, 1, "0123456789-+eE.[]{}\":,"[random() % 22]);
      }
      if (text.empty()) text = "{";
    }
    try {
      read_request(text, robot());
      ++taken;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(taken, 20000);
  EXPECT_LT(taken, 80000);
}

}  // namespace
}  // namespace sinew::live
