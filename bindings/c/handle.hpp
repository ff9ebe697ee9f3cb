#pragma once

#include <atomic>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/simulation.hpp>

#include "barchan.h"

/// What a caller's pointer stands for.
struct barchan_sim {
  explicit barchan_sim(barchan::Simulation&& of) : simulation(std::move(of)) {}
  barchan::Simulation simulation;
  std::atomic<bool> is_busy{false};       ///< some thread is in a call
  std::atomic<std::thread::id> caller{};  ///< which; its callbacks may call, too
};

struct barchan_state {
  barchan::State state;
};

namespace barchan::c {

/// Of this thread's last error.
[[nodiscard]] const std::string& error_text();
/// Keeps the text for barchan_error(). @return `code`
int fail(int code, const std::string& text);
int fail_as(const std::exception& error);

// Handles that callers hold: a wrong one is told from a right one.
void note(const barchan_sim* sim);
void note(const barchan_state* state);
void forget(const void* handle);
[[nodiscard]] bool is_known(const void* handle);

/// Errors: std::invalid_argument
inline void require(bool is_right, const char* what) {
  if (!is_right) throw std::invalid_argument(what);
}

/// Calls work() and turns what it throws into a code.
template <class Work>
int guarded(Work&& work) {
  try {
    work();
    return BARCHAN_OK;
  } catch (const std::exception& error) {
    return fail_as(error);
  } catch (...) {
    return fail(BARCHAN_FAILED, "an exception of unknown kind");
  }
}

/// Calls work(simulation) for a handle that is known and that no other thread uses.
template <class Work>
int with(barchan_sim* sim, Work&& work) {
  if (sim == nullptr) return fail(BARCHAN_WRONG_CALL, "the simulation is NULL: open one first");
  if (!is_known(sim))
    return fail(BARCHAN_WRONG_CALL, "there is no such simulation: it was closed, or never opened");
  if (sim->is_busy && sim->caller == std::this_thread::get_id())  // from within a callback
    return guarded([&] { work(sim->simulation); });
  if (sim->is_busy.exchange(true))
    return fail(BARCHAN_WRONG_CALL,
                "another thread is in a call of this simulation: one thread at a time");
  sim->caller = std::this_thread::get_id();
  const int code = guarded([&] { work(sim->simulation); });
  sim->caller = std::thread::id();
  sim->is_busy = false;
  return code;
}

}  // namespace barchan::c
