// The program's commands, one function each; they return the exit code and throw InputError on bad input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sinew::app {

// Exit codes (NOTATION.md).
inline constexpr int kDone = 0, kFailed = 1, kBadInput = 2, kNumericalStop = 3, kWarned = 4, kInterrupted = 130;

struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path output = "out";
  std::vector<std::string> overrides;
  std::filesystem::path commands;  ///< a table that drives the actuators of its columns
  std::filesystem::path resume;
  bool force = false;
  bool quiet = false;
  bool profile = false;
  bool strict = false;  ///< warnings have an exit code of their own
  int threads = 0;      ///< 0: two, if the machine has them
};

struct WorkspaceOptions {
  std::filesystem::path scene;
  std::filesystem::path output = "out";
  std::vector<std::string> overrides;
  int samples = 300;
  bool quiet = false;
  int threads = 1;
};

struct ViewOptions {
  std::filesystem::path what;    ///< a scene file, or a run's folder or recording
  std::filesystem::path folder;  ///< where files that the scene names are looked for; empty: beside it
  std::vector<std::string> overrides;
  std::string address = "127.0.0.1";
  int port = 0;                        ///< 0: any that is free
  std::string token;                   ///< empty: a random one
  std::vector<std::string> embedders;  ///< whose pages may show this one in a frame
  bool open = false;                   ///< a browser
  int threads = 0;                     ///< 0: two, if the machine has them
};

int run_scene(const RunOptions& options);
int view(const ViewOptions& options);
int export_page(const std::filesystem::path& folder, const std::filesystem::path& file, int frames);
int map_workspace(const WorkspaceOptions& options);
int check_scene(const std::filesystem::path& scene, const std::vector<std::string>& overrides, bool strict);
int describe_mesh(const std::filesystem::path& path);
int export_run(const std::filesystem::path& folder);
int print_schema();

}  // namespace sinew::app
