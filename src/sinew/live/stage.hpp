// What pages look at: a simulation that goes on while they watch, or a recorded run that is played.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "sinew/io/recording.hpp"
#include "sinew/live/request.hpp"
#include "sinew/live/scenery.hpp"
#include "sinew/sim/run.hpp"

namespace sinew::live {

/// A message that many pages share.
using Bytes = std::shared_ptr<const std::string>;
/// Called, on the stage's thread, with every frame and the number that pages acknowledge it by.
using OnFrame = std::function<void(Bytes, long number)>;

/// What whoever looks has asked for and is not done with. Each request changes a part of it at once, so that however
/// many come nothing piles up.
struct Wishes {
  bool playing = true;
  int steps = 0;  ///< to be made although it stands
  bool reset = false;
  double speed = 1.0;
  std::map<int, double> told;            ///< of actuators, where not the scene's own
  std::map<int, Eigen::VectorXd> aimed;  ///< of effectors
  std::optional<Grip> grip;
  std::optional<long> sought;  ///< frame of a recorded run
  Show show;
  bool changed = true;  ///< what is shown is to be told again
};

void take(const Request& request, Wishes& wishes);

/// Steps a model in the time of the wall, or as fast as it can, on a thread of its own. A step that cannot be made
/// pauses it at the last state; the frame says why. What is told, and what targets ask of motors, goes at
/// the pace of a hand.
class Simulation {
 public:
  /// Dynamic and quasi-static scenes; throws InputError for others.
  Simulation(const Model& model, int threads, OnFrame on_frame);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  std::string scene();
  void take(const Request& request);

 private:
  using Clock = std::chrono::steady_clock;
  /// Goals of one step, and what leads them there.
  struct Lead {
    Goal goal;
    Eigen::VectorXd speed;
    std::vector<bool> hands;  ///< effectors whose goal is, or was, a hand's
  };
  void work();
  bool advance_once(const Wishes& wishes);
  Lead led(Goal goal, const Wishes& wishes) const;
  void publish(const Wishes& wishes);
  void begin();

  const Model model_;
  OnFrame on_frame_;
  Scenery scenery_;
  Workspace workspace_;
  State state_;
  Lead lead_;
  StepReport report_;
  std::string trouble_;
  double calm_ = 0.0;  ///< [s] from when on nothing pulls at bodies, nor has of late
  long frame_ = 0;
  double realtime_ = 0.0, step_seconds_ = 0.0, frame_seconds_ = 0.0;

  std::mutex mutex_;  ///< of what follows
  std::condition_variable wake_;
  Wishes wishes_;
  std::atomic<bool> end_ = false;  ///< (a step that is running looks without the mutex)
  std::thread thread_;
};

/// Plays a recorded run, which has a step.
class Replay {
 public:
  /// Without `on_frame` it does not play, and frames are asked for.
  Replay(const Model& model, io::Recording recording, OnFrame on_frame);
  ~Replay();
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  std::string scene();
  void take(const Request& request);
  /// One frame of it; of a step that cannot be read the start, and why. The last one says so if the run was not whole.
  /// Not while it plays.
  std::string frame(long number, const Wishes& wishes);
  long frames() const { return static_cast<long>(recording_.steps.size()); }

 private:
  void work();

  const Model& model_;
  io::Recording recording_;
  OnFrame on_frame_;
  Scenery scenery_;

  std::mutex mutex_;  ///< of what follows
  std::condition_variable wake_;
  Wishes wishes_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace sinew::live
