#include <barchan/app/verdict.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <new>
#include <string>
#include <thread>

#include <barchan/app/command_line.hpp>
#include <barchan/comm/base/first_to_fail.hpp>
#include <barchan/comm/base/watchdog.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/stop_request.hpp>

namespace barchan::app {
namespace {

/// Rank 0 speaks first, or whoever else knows more.
constexpr std::chrono::seconds kTurn{2};
/// For those that wait for a message: the limit is over for all of them at about the same time.
constexpr std::chrono::seconds kLastWords{5};
/// Another rank has ended the run, or is about to; this one is as good as gone.
constexpr std::chrono::seconds kEnd{20};

void print_error(const std::string& what) {
  std::fflush(stdout);
  std::fprintf(stderr, "barchan: %s\n", what.c_str());
  std::fflush(stderr);
}

/// Until another rank ends the run, or the time is over. A launcher ends ranks by SIGTERM, and
/// after a second by SIGKILL; it may have begun already.
void give_way(std::chrono::seconds turn) {
  std::signal(SIGTERM, SIG_DFL);
  std::this_thread::sleep_for(stop_is_requested() ? kEnd : turn);
}

/// An error that this rank may be the only one to know, or all of them at once.
[[noreturn]] void end_alone(const Communicator& world, const std::string& what) {
  if (!world.is_root() || stop_is_requested()) give_way(kTurn);
  print_error(what);
  world.abort(kFailed);
}

/// An error of a step, which others may have found too, there or in the next one.
[[noreturn]] void end_in_step(const Communicator& world, const StepError& error,
                              const std::string& what) {
  std::signal(SIGTERM, SIG_DFL);
  if (!is_first_to_fail(world, error.order(), kTurn) || stop_is_requested()) give_way(kEnd);
  print_error(what);
  world.abort(kFailed);
}

/// Every rank is here with the same words.
[[noreturn]] void end_together(const Communicator& world, const std::string& what) {
  if (world.is_root())
    print_error(what);
  else
    give_way(kEnd);
  world.abort(kFailed);
}

/// @param error  what is behind the words
int fail(const Communicator* world, const std::exception& error, const std::string& what) {
  if (world == nullptr || world->size() == 1) {
    print_error(what);
    return kFailed;
  }
  if (dynamic_cast<const CommonError*>(&error) != nullptr) end_together(*world, what);
  if (const auto* in_step = dynamic_cast<const StepError*>(&error))
    end_in_step(*world, *in_step, what);
  end_alone(*world, what);
}

}  // namespace

int with_verdict(const Communicator* world, const std::function<void()>& work) {
  try {
    work();
    return kDone;
  } catch (const InputError& e) {
    if (world == nullptr || world->is_root()) print_error(e.what());
    return kWrongInput;
  } catch (const std::bad_alloc& e) {
    return fail(world, e, "out of memory");
  } catch (const WaitError& e) {
    if (world == nullptr) return fail(world, e, e.what());
    end_waiting(*world, e.what());
  } catch (const std::exception& e) {
    return fail(world, e, e.what());
  }
}

void end_run(const Communicator& world, const std::exception& error, const std::string& what) {
  if (world.size() > 1) fail(&world, error, what);
  throw RunError(what);
}

void end_waiting(const Communicator& world, const std::string& what) {
  print_error(what);
  give_way(kLastWords);  // so that the others can say theirs
  world.abort(kFailed);
}

void on_rank_zero(const Communicator& world, const std::function<void()>& work) {
  agree(world, [&] {
    if (world.is_root()) work();
  });
}

}  // namespace barchan::app
