#include <fmt/ranges.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "sinew/commands.hpp"
#include "sinew/error/input_error.hpp"
#include "sinew/io/append_file.hpp"
#include "sinew/live/export_page.hpp"
#include "sinew/live/page.hpp"
#include "sinew/live/server.hpp"
#include "sinew/live/stage.hpp"
#include "sinew/runs/record.hpp"
#include "sinew/terminal.hpp"

namespace sinew::app {

namespace {

/// Waits for Ctrl-C, or for whoever started the program to end it. The signals are blocked in all threads before.
void wait_for_the_end(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
}

sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

/// Where a browser finds what is served on an address: of all interfaces the first that is not this machine's alone.
std::string address_of(const std::string& served) {
  if (served != "0.0.0.0" && served != "::") return served;
  ifaddrs* all = nullptr;
  std::string found = served == "::" ? "::1" : "127.0.0.1";
  if (getifaddrs(&all) != 0) return found;
  for (const ifaddrs* own = all; own; own = own->ifa_next) {
    char text[NI_MAXHOST] = "";
    if (!own->ifa_addr || own->ifa_addr->sa_family != AF_INET || (own->ifa_flags & IFF_LOOPBACK) != 0) continue;
    if (getnameinfo(own->ifa_addr, sizeof(sockaddr_in), text, sizeof(text), nullptr, 0, NI_NUMERICHOST) != 0) continue;
    found = text;
    break;
  }
  freeifaddrs(all);
  return found;
}

bool is_recording(const std::filesystem::path& given) {
  return std::filesystem::is_directory(given) || given.extension() == ".sinew";
}

/// Serves what a stage shows until it is to end.
template <class Make>
int serve(const ViewOptions& options, const Model& model, const Make& make) {
  const sigset_t signals = block_signals();
  std::unique_ptr<live::Server> server;
  std::mutex mutex;  // frames may come before there is a server
  const auto stage = make([&](live::Bytes frame, long number) {
    const std::lock_guard lock(mutex);
    if (server) server->publish(std::move(frame), number);
  });
  live::Behind behind;
  behind.page = live::page();
  stage->take(live::Pause{});  // until somebody looks
  behind.scene = [&, begun = false]() mutable {
    if (!std::exchange(begun, true)) stage->take(live::Play{});
    return stage->scene();
  };
  behind.read = [&model](std::string_view text) { return live::read_request(text, model); };
  behind.take = [&](const live::Request& request) { stage->take(request); };
  behind.report = [](const std::string& text) { complain("{}\n", text); };
  live::Place place{options.address, options.port, options.token.empty() ? live::random_token() : options.token};
  if (!options.embedders.empty()) place.frame_ancestors = fmt::format("{}", fmt::join(options.embedders, " "));
  {
    const std::lock_guard lock(mutex);
    server = std::make_unique<live::Server>(place, std::move(behind));
  }
  if (!live::is_loopback(place.address))
    complain(
        "warning: whoever reaches {} and knows the address below can see and move this robot; what is sent is "
        "not encrypted. Better leave --bind out and use: ssh -L {}:127.0.0.1:{} this-machine\n",
        place.address, server->port(), server->port());
  const std::string host = address_of(place.address);
  const std::string address =
      fmt::format("http://{}:{}/?token={}", host.find(':') == std::string::npos ? host : "[" + host + "]",
                  server->port(), place.token);
  say("Open {}\nCtrl-C ends it.\n", address);
  std::fflush(stdout);
  if (options.open && std::getenv("DISPLAY") &&
      std::system(fmt::format("xdg-open '{}' >/dev/null 2>&1 &", address).c_str()) != 0)
    complain("the browser could not be started; open the address yourself\n");
  wait_for_the_end(signals);
  const std::lock_guard lock(mutex);
  server.reset();
  return kDone;
}

}  // namespace

int view(const ViewOptions& options) {
  if (is_recording(options.what)) {
    if (!options.overrides.empty())
      throw InputError({.path = "--set",
                        .value = options.overrides.front(),
                        .rule = "does not change a run that is recorded already",
                        .remedy = "view the scene itself, or run it again with --set"});
    const std::filesystem::path path =
        std::filesystem::is_directory(options.what) ? runs::recording_path(options.what) : options.what;
    io::Recording recording = io::read_recording(path);
    const runs::LoadedScene loaded = runs::load_recorded(recording, path);
    if (recording.steps.empty())
      throw InputError({path.string(), 0, "", "", "holds no finished step", "run the scene again"});
    return serve(options, loaded.model, [&](live::OnFrame on_frame) {
      return std::make_unique<live::Replay>(loaded.model, std::move(recording), std::move(on_frame));
    });
  }
  const std::filesystem::path folder = options.folder.empty() ? options.what.parent_path() : options.folder;
  const runs::LoadedScene loaded =
      runs::load(io::parse_scene(io::read_text(options.what), options.what, folder, options.overrides));
  for (const Warning& warning : loaded.model.warnings) complain("warning: {}\n", to_string(warning));
  return serve(options, loaded.model, [&](live::OnFrame on_frame) {
    return std::make_unique<live::Simulation>(
        loaded.model, options.threads > 0 ? options.threads : runs::usual_threads(), std::move(on_frame));
  });
}

int export_page(const std::filesystem::path& folder, const std::filesystem::path& file, int frames) {
  const std::filesystem::path path = runs::recording_path(folder);
  io::Recording recording = io::read_recording(path);
  const runs::LoadedScene loaded = runs::load_recorded(recording, path);
  if (recording.steps.empty())
    throw InputError({path.string(), 0, "", "", "holds no finished step", "run the scene again"});
  live::Replay replay(loaded.model, std::move(recording), nullptr);
  const std::string html = live::standalone_page(replay, frames);
  io::AppendFile out(file, io::AppendFile::Start::empty);
  out.append(html);
  say("{}: plays by itself, {:.1f} MB\n", file.string(), static_cast<double>(html.size()) * 1e-6);
  return kDone;
}

}  // namespace sinew::app
