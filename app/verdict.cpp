#include <barchan/app/verdict.hpp>

#include <chrono>
#include <cstdio>
#include <new>
#include <string>
#include <thread>

#include <barchan/app/command_line.hpp>
#include <barchan/comm/watchdog.hpp>
#include <barchan/core/error.hpp>
#include <barchan/tasks/results/agree.hpp>

namespace barchan::app {
namespace {

/// Long enough for rank 0 to say the same first.
constexpr std::chrono::seconds kTurn{2};

void print_error(const std::string& what) {
  std::fflush(stdout);
  std::fprintf(stderr, "barchan: %s\n", what.c_str());
  std::fflush(stderr);
}

int fail(const Communicator* world, const std::string& what) {
  if (world == nullptr || world->size() == 1) {
    print_error(what);
    return kFailed;
  }
  if (!world->is_root()) std::this_thread::sleep_for(kTurn);
  print_error(what);
  world->abort(kFailed);
}

}  // namespace

int with_verdict(const Communicator* world, const std::function<void()>& work) {
  try {
    work();
    return kDone;
  } catch (const InputError& e) {
    if (world == nullptr || world->is_root()) print_error(e.what());
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    return fail(world, "out of memory");
  } catch (const WaitError& e) {
    if (world == nullptr) return fail(world, e.what());
    end_waiting(*world, e.what());
  } catch (const std::exception& e) {
    return fail(world, e.what());
  }
}

void end_run(const Communicator& world, const std::string& what) {
  if (world.size() > 1) fail(&world, what);
  throw RunError(what);
}

void end_waiting(const Communicator& world, const std::string& what) {
  print_error(what);
  std::this_thread::sleep_for(kTurn);  // so that the others can say theirs
  world.abort(kFailed);
}

void on_rank_zero(const Communicator& world, const std::function<void()>& work) {
  agree(world, [&] {
    if (world.is_root()) work();
  });
}

}  // namespace barchan::app
