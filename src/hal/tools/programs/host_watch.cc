// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/programs/host_watch.hh"

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <utility>

namespace mw::hal::tools {
namespace {

constexpr auto LOOK_EVERY = std::chrono::milliseconds(20);
constexpr auto INTERRUPT_EVERY = std::chrono::milliseconds(10);

/// Sleeps; returns false at once when the watch ends.
bool hasSlept(const std::stop_token &stop, std::chrono::milliseconds time) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
}

}  // namespace

HostWatch::HostWatch(const HostClient &host, std::function<void()> on_death)
    : thread_([&host, on_death = std::move(on_death), maker = ::pthread_self()](const std::stop_token &stop) {
          // The thread that runs commands handles signals of the process.
          sigset_t all;
          ::sigfillset(&all);
          ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
          while (!host.death()) {
              if (!hasSlept(stop, LOOK_EVERY)) {
                  return;
              }
          }
          on_death();
          while (hasSlept(stop, INTERRUPT_EVERY)) {
              ::pthread_kill(maker, SIGTERM);
          }
      }) {}

HostWatch::~HostWatch() = default;

}  // namespace mw::hal::tools
