#include <barchan/tasks/agree.hpp>

#include <exception>
#include <new>
#include <string>

#include <barchan/core/base/error.hpp>

namespace barchan {

void agree(const Communicator& communicator, const std::function<void()>& work) {
  std::string error;  // its first letter tells the kind
  try {
    work();
  } catch (const InputError& e) {
    error = std::string("I") + e.what();
  } catch (const std::bad_alloc&) {
    error = "Rout of memory";
  } catch (const std::exception& e) {
    error = std::string("R") + e.what();
  }
  error = communicator.first_error(error);
  if (error.empty()) return;
  if (error.front() == 'I') throw InputError(error.substr(1), "");
  throw CommonError(error.substr(1));
}

void agree_between_steps(const Communicator& communicator, const std::string& where,
                         const std::function<void()>& work) {
  std::string error;
  const auto say = [&](const char* what) {
    error = where + ", rank " + std::to_string(communicator.rank()) + ": " + what;
  };
  try {
    work();
  } catch (const std::exception& e) {
    say(e.what());
  } catch (...) {
    say("an exception of unknown kind");
  }
  error = communicator.first_error(error);
  if (!error.empty()) throw AgreedError(error);
}

}  // namespace barchan
