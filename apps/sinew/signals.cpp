#include "sinew/signals.hpp"

#include <atomic>
#include <csignal>

namespace sinew::app {

namespace {

std::atomic<bool> noted = false;

void note(int signal) {
  noted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void note_signals() {
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool signalled() { return noted.load(); }

}  // namespace sinew::app
