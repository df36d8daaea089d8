// sinew: simulates soft robots from scene files.
#include <fcntl.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <regex>
#include <sstream>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/append_file.hpp"
#include "sinew/terminal.hpp"

namespace {

constexpr const char* kExamples = R"(
Examples:
  sinew run examples/finger.yaml -o out/finger        simulate, write tables, ParaView files and a picture
  sinew run finger.yaml -o out --set actuators.pull.displacement="5 mm" --set rods.cable.sections=30
  sinew run finger.yaml --profile --threads 1         where the time of a step goes
  sinew run reach.yaml --commands out/commands.csv    the commands that were found, without looking for them again
  sinew run --resume out/finger                       go on with a run that was stopped
  sinew view examples/reach.yaml                      a page in the browser: drag the tip, push the body
  sinew view out/finger                               the same of a run that was recorded
  sinew export out/finger -o finger.html              one file that plays by itself
  sinew workspace reach.yaml -o out --samples 500     where the motors can bring the tip
  sinew check finger.yaml                             what the engine makes of a scene; does not run it
  sinew info finger.vtk                               sizes and quality of a mesh
  sinew schema > sinew.schema.json                    JSON Schema of scene files, for editors

Exit codes: 0 done; 1 the machine refused (no memory), or an error of Sinew itself; 2 bad input, or something that
cannot be read or written; 3 numerical stop (results kept); 4 warnings (with --strict; results kept);
130 interrupted (results kept).)";

/// Standard input, output and errors that are closed lead nowhere from now on: the next file to be opened would take
/// their place, and what is meant for people would go into it.
void open_standard_streams() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    if (::open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY) != descriptor) std::_Exit(sinew::app::kFailed);
  }
}

/// What a command throws becomes a message and an exit code.
template <class Command>
int end_of(const Command& command) {
  using sinew::app::complain;
  try {
    return command();
  } catch (const sinew::InputError& error) {
    complain("{}\n", error.what());
    return sinew::app::kBadInput;
  } catch (const sinew::io::WriteError& error) {
    complain("{}\n", error.what());
    return sinew::app::kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    complain("{}: cannot be read or written: {}\n    check the path, and who may use it\n", error.path1().string(),
             error.code().message());
    return sinew::app::kBadInput;
  } catch (const std::bad_alloc&) {
    complain(
        "sinew: the machine has no memory left for this; what was recorded is kept\n    free memory, or make less "
        "of it: a coarser mesh, fewer sections, fewer frames\n");
  } catch (const std::exception& error) {
    complain("sinew: {}\n    this is an error of Sinew, or the machine refused something; please report it\n",
             error.what());
  }
  return sinew::app::kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace sinew::app;
  open_standard_streams();
  CLI::App program("Sinew simulates soft robots moved by cables, rods and tubes. All units are SI.", "sinew");
  program.footer(kExamples);
  program.set_version_flag("--version", "sinew " SINEW_VERSION);
  program.require_subcommand(1);

  sinew::app::RunOptions options;
  CLI::App* run = program.add_subcommand("run", "Simulate a scene and write its results into a folder");
  CLI::Option* scene = run->add_option("scene", options.scene, "Scene file (YAML)");
  CLI::Option* output = run->add_option("-o,--output", options.output, "Folder for the results")->capture_default_str();
  CLI::Option* set =
      run->add_option("--set", options.overrides, "Change the scene: path=value, as in time.step=\"5 ms\"")
          ->type_name("PATH=VALUE");
  CLI::Option* replay = run->add_option("--commands", options.commands,
                                        "Drive actuators by the columns of this CSV table, as commands.csv of a run "
                                        "with targets, which are then left out");
  run->add_option("--resume", options.resume, "Go on with the run recorded in this folder")
      ->excludes(scene)
      ->excludes(output)
      ->excludes(set)
      ->excludes(replay);
  run->add_flag("--force", options.force, "Replace the results of an earlier run in the folder");
  run->add_flag("-q,--quiet", options.quiet, "No progress and no list of files");
  run->add_flag("--strict", options.strict, "End with exit code 4 where anything was warned of");
  run->add_flag("--profile", options.profile, "Show at the end where the time went, stage by stage");
  run->add_option("--threads", options.threads, "Threads that share a step; the results are the same for any number")
      ->check(CLI::Range(1, 64))
      ->default_str("2");

  std::filesystem::path checked;
  std::vector<std::string> check_overrides;
  bool check_strict = false;
  CLI::App* check = program.add_subcommand("check", "Read and build a scene and explain what came of it; does not run");
  check->add_option("scene", checked, "Scene file (YAML)")->required();
  check->add_option("--set", check_overrides, "Change the scene: path=value")->type_name("PATH=VALUE");

  check->add_flag("--strict", check_strict, "End with exit code 4 where anything is warned of");

  sinew::app::WorkspaceOptions reach;
  CLI::App* workspace = program.add_subcommand(
      "workspace",
      "Find what targets can be brought to: equilibria all over the limits of actuators that are `inverse`");
  workspace->add_option("scene", reach.scene, "Scene file (YAML)")->required();
  workspace->add_option("-o,--output", reach.output, "Folder for workspace.csv and workspace.png")
      ->capture_default_str();
  workspace->add_option("--samples", reach.samples, "How many equilibria")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  workspace->add_option("--set", reach.overrides, "Change the scene: path=value")->type_name("PATH=VALUE");
  workspace->add_flag("-q,--quiet", reach.quiet, "No progress");
  workspace->add_option("--threads", reach.threads, "Threads that share an equilibrium")->check(CLI::Range(1, 64));

  std::filesystem::path mesh;
  CLI::App* info =
      program.add_subcommand("info", "Sizes and quality of a mesh (legacy VTK, VTU, Gmsh, Abaqus; surfaces: STL, OBJ)");
  info->add_option("mesh", mesh, "Mesh file")->required();

  std::filesystem::path recorded;
  CLI::App* views =
      program.add_subcommand("export", "Write tables, ParaView files and the picture again from a run's recording");
  views->add_option("folder", recorded, "Folder of the run")->required();
  std::filesystem::path standalone;
  int frames = 600;
  views->add_option("-o,--output", standalone,
                    "Instead of these one HTML file that plays the run in any browser, without a network");
  views->add_option("--frames", frames, "Frames of it, at most")->check(CLI::Range(1, 100000))->capture_default_str();

  sinew::app::ViewOptions viewed;
  CLI::App* view = program.add_subcommand("view", "Show a scene live, or a recorded run, in a page of the browser");
  view->add_option("what", viewed.what, "Scene file (YAML), or the folder of a run")->required();
  view->add_option("--set", viewed.overrides, "Change the scene: path=value")->type_name("PATH=VALUE");
  view->add_option("--folder", viewed.folder, "Where files that the scene names are looked for, if not beside it");
  view->add_option("--port", viewed.port, "Port to serve on; any that is free if left out")
      ->check(CLI::Range(0, 65535));
  view->add_option("--bind", viewed.address,
                   "Address to serve on; others than this machine can reach it then, if they know the token")
      ->capture_default_str();
  view->add_option("--token", viewed.token, "What the address ends with; random if left out")
      ->envname("SINEW_TOKEN")
      ->check([](const std::string& token) {
        const bool plain =
            token.size() >= 16 && token.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyz") == std::string::npos;
        return plain ? std::string() : std::string("must be 16 or more small letters and digits");
      });
  view->add_option("--embed-in", viewed.embedders,
                   "Whose pages may show this one in a frame, as http://localhost:8888; no other page may")
      ->type_name("ORIGIN")
      ->allow_extra_args(false)
      ->check([](const std::string& origin) {
        static const std::regex kOrigin("[a-z][a-z0-9+.-]*:(//(\\*\\.)?[A-Za-z0-9.-]+(:([0-9]+|\\*))?)?");
        return std::regex_match(origin, kOrigin)
                   ? std::string()
                   : std::string(
                         "must be a scheme and a host, as http://localhost:8888 or http://localhost:*, or a scheme "
                         "alone, as vscode-webview:");
      });
  view->add_flag("--open", viewed.open, "Open a browser");
  view->add_option("--threads", viewed.threads, "Threads that share a step")->check(CLI::Range(1, 64));

  program.add_subcommand("schema", "Print the JSON Schema of scene files");

  const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
  const auto is_command = [&commands](const char* word) {
    return std::any_of(commands.begin(), commands.end(),
                       [word](const CLI::App* command) { return command->get_name() == word; });
  };
  const int code = end_of([&] {
    if (argc > 1 && argv[1][0] != '-' && !is_command(argv[1])) {
      complain(
          "{}: is not a command of sinew\n    the commands are run, view, workspace, check, info, export, schema; see "
          "sinew --help\n",
          argv[1]);
      return kBadInput;
    }
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      std::ostringstream help;
      std::ostringstream wrong;
      const int ends = program.exit(error, help, wrong);
      write(stdout, help.str());
      write(stderr, wrong.str());
      return ends == 0 ? kDone : kBadInput;
    }
    if (*run) return run_scene(options);
    if (*workspace) return map_workspace(reach);
    if (*check) return check_scene(checked, check_overrides, check_strict);
    if (*info) return describe_mesh(mesh);
    if (*view) return sinew::app::view(viewed);
    if (*views) return standalone.empty() ? export_run(recorded) : export_page(recorded, standalone, frames);
    return print_schema();
  });
  const std::string lost = standard_output_failed();
  if (lost.empty()) return code;
  complain("standard output: cannot be written: {}\n    free space there, or send it elsewhere\n", lost);
  return code == kDone ? kBadInput : code;
}
