#include "handle.hpp"

#include <mutex>
#include <set>

namespace barchan::c {
namespace {

thread_local std::string last_error;

std::mutex& guard() {
  static std::mutex mutex;
  return mutex;
}

std::set<const void*>& handles() {
  static std::set<const void*> all;
  return all;
}

void note_any(const void* handle) {
  const std::lock_guard<std::mutex> lock(guard());
  handles().insert(handle);
}

}  // namespace

const std::string& error_text() {
  return last_error;
}

int fail(int code, const std::string& text) {
  last_error = text;
  return code;
}

int fail_as(const std::exception& error) {
  const auto is = [&error]<class Error>(const Error* /*kind*/) {
    return dynamic_cast<const Error*>(&error) != nullptr;
  };
  constexpr const InputError* kInput = nullptr;
  constexpr const AgreedError* kAgreed = nullptr;
  constexpr const std::logic_error* kLogic = nullptr;
  const int code = is(kInput)    ? BARCHAN_WRONG_INPUT
                   : is(kAgreed) ? BARCHAN_RUN_ENDED
                   : is(kLogic)  ? BARCHAN_WRONG_CALL
                                 : BARCHAN_FAILED;
  return fail(code, error.what());
}

void note(const barchan_sim* sim) {
  note_any(sim);
}
void note(const barchan_state* state) {
  note_any(state);
}
void forget(const void* handle) {
  const std::lock_guard<std::mutex> lock(guard());
  handles().erase(handle);
}
bool is_known(const void* handle) {
  const std::lock_guard<std::mutex> lock(guard());
  return handles().contains(handle);
}

}  // namespace barchan::c

extern "C" const char* barchan_error() {
  return barchan::c::error_text().c_str();
}
