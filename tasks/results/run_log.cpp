#include <barchan/tasks/results/run_log.hpp>

#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include <barchan/tasks/results/run_summary.hpp>

namespace barchan {
namespace {

constexpr char kWarning = 'W', kPlain = 'N';  // before a note's text, on its way to rank 0

std::string packed(const std::vector<Note>& notes) {
  std::string text;
  for (const Note& note : notes) {
    text += note.is_warning ? kWarning : kPlain;
    text += note.text + '\n';
  }
  return text;
}

std::string first_line(const Simulation& simulation) {
  const Communicator& communicator = simulation.communicator();
  return fmt::format(
      "barchan {}, {} rank{} of {} thread{}, exchange {}: from step {} with {} particles",
      version(), communicator.size(), communicator.size() == 1 ? "" : "s",
      simulation.options().threads, simulation.options().threads == 1 ? "" : "s",
      simulation.exchange_choice().name, simulation.step(), simulation.num_particles());
}

}  // namespace

RunLog::RunLog(const Simulation& simulation, std::string path, bool continues) {
  if (!simulation.communicator().is_root()) return;
  path_ = std::move(path);
  if (!continues) std::remove(path_.c_str());
  add(first_line(simulation));
}

void RunLog::add(const std::string& line) {
  if (path_.empty()) return;
  std::FILE* file = std::fopen(path_.c_str(), "ab");
  if (file == nullptr) return;
  std::fputs((line + '\n').c_str(), file);
  std::fclose(file);
}

void RunLog::warn(const std::string& text) {
  if (path_.empty()) return;
  add("warning: " + text);
  warnings_.push_back(text);
}

void RunLog::take_notes(Simulation& simulation) {
  const auto of_ranks = simulation.communicator().gather(packed(simulation.take_notes()));
  for (const std::string& notes : of_ranks) {
    for (std::size_t begin = 0; begin < notes.size();) {
      const std::size_t end = notes.find('\n', begin);
      const std::string text = notes.substr(begin + 1, end - begin - 1);
      notes[begin] == kWarning ? warn(text) : add(text);
      begin = end + 1;
    }
  }
  if (path_.empty()) return;
  const std::string checkpoint = simulation.last_checkpoint();
  if (checkpoint.empty() || checkpoint == last_checkpoint_) return;
  last_checkpoint_ = checkpoint;
  add("checkpoint " + checkpoint);
}

std::vector<std::string> RunLog::take_warnings() {
  return std::exchange(warnings_, {});
}

}  // namespace barchan
