#include <barchan/app/experiments/lab.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include <barchan/app/experiments/programs.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/base/nearest.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

constexpr std::array<std::string_view, 11> kWords{
    "hosts", "delay", "rate", "jitter", "spike", "mtu", "queue", "seed", "osc", "mpi", "env"};
constexpr std::array<std::string_view, 5> kFlags{"even-price", "realtime", "reorder", "no-offload",
                                                 "no-pin"};
constexpr const char* kRemedy = "give words such as hosts=2,delay=0:200us,rate=1gbit";

template <std::size_t N>
bool is_in(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

[[noreturn]] void refuse(const std::string& word) {
  std::vector<std::string_view> known(kWords.begin(), kWords.end());
  known.insert(known.end(), kFlags.begin(), kFlags.end());
  throw InputError(fmt::format("--lab: there is no '{}'", word), deck::suggest(word, known));
}

Axis axis_of(const std::string& text) {
  const auto equals = text.find('=');
  const std::string word = text.substr(0, equals);
  const bool is_flag = is_in(kFlags, word);
  if (!is_flag && !is_in(kWords, word)) refuse(word);
  if (equals == std::string::npos) {
    if (is_flag) return {word, {"yes"}};
    throw InputError(fmt::format("--lab: '{}' has no value", word), kRemedy);
  }
  Axis axis{word, split(text.substr(equals + 1), ':')};
  for (const std::string& value : axis.values) {
    if (value.empty()) throw InputError(fmt::format("--lab: '{}' has no value", text), kRemedy);
    if (is_flag && value != "yes" && value != "no")
      throw InputError(fmt::format("--lab: '{}' is neither yes nor no", text),
                       fmt::format("give {0}, or {0}=yes:no for both", word));
  }
  return axis;
}

int number_of(const std::string& text) {
  int number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() ? number : 0;
}

/// What Open MPI 4 needs for windows between hosts over TCP; later ones find a component.
std::string usual_osc(int ranks_per_host) {
  if (mpi_library_version().find("Open MPI v4") == std::string::npos) return {};
  return ranks_per_host > 1 ? "sm,pt2pt" : "pt2pt";
}

void add_flags(const Point& point, std::vector<std::string>& words) {
  for (const auto& [axis, value] : point) {
    if (axis == "hosts" || axis == "osc" || axis == "mpi" || !is_of_lab(axis)) continue;
    if (is_in(kFlags, axis)) {
      if (value == "yes") words.push_back("--" + axis);
    } else {
      words.insert(words.end(), {"--" + axis, value});
    }
  }
}

}  // namespace

bool is_of_lab(const std::string& axis) {
  return is_in(kWords, axis) || is_in(kFlags, axis);
}

std::vector<Axis> parse_lab(const std::string& text) {
  std::vector<Axis> axes{{"hosts", {"2"}}};
  for (const std::string& word : split(text, ',')) {
    const Axis axis = axis_of(word);
    const auto same = std::find_if(axes.begin(), axes.end(),
                                   [&](const Axis& other) { return other.name == axis.name; });
    if (same == axes.end())
      axes.push_back(axis);
    else
      same->values = axis.values;
  }
  for (const std::string& value : axes.front().values) {
    if (number_of(value) < 1 || number_of(value) > 64)
      throw InputError(fmt::format("--lab: hosts={} is no number from 1 to 64", value), kRemedy);
  }
  return axes;
}

std::string find_netlab() {
  const char* given = std::getenv("BARCHAN_NETLAB");
  std::vector<std::string> places;
  if (given != nullptr && *given != '\0') places.emplace_back(given);
  fs::path folder = fs::path(own_path()).parent_path();
  places.push_back(folder / "barchan-netlab");
  places.push_back(find_program("barchan-netlab"));
  for (int up = 0; up < 3; ++up, folder = folder.parent_path())
    places.push_back(folder / "bench/netlab/netlab");
  for (const std::string& place : places) {
    if (is_program(place)) return place;
  }
  throw InputError("--lab: there is no barchan-netlab beside this program or in PATH",
                   "install barchan, or name the lab's command by BARCHAN_NETLAB");
}

void check_lab(const std::string& netlab, const std::vector<Point>& points) {
  std::set<std::vector<std::string>> asked;
  for (const Point& point : points) {
    std::vector<std::string> words = lab_words(netlab, point);
    words.insert(words.end() - 1, "--check");
    words.emplace_back("true");
    std::string said;
    if (!asked.insert(words).second || run_for_output(words, said) == 0) continue;
    const auto from = said.rfind("netlab: ");
    said.erase(0, from == std::string::npos ? 0 : from + std::string("netlab: ").size());
    if (said.starts_with("error: ")) said.erase(0, std::string("error: ").size());
    throw InputError("--lab: " + said.substr(0, said.find_last_not_of('\n') + 1),
                     "barchan-netlab --help lists what it takes");
  }
}

std::vector<std::string> lab_words(const std::string& netlab, const Point& point) {
  const int hosts = number_of(value_of(point, "hosts"));
  const int ranks = number_of(value_of(point, "ranks"));
  if (ranks % hosts != 0)
    throw InputError(
        fmt::format("--lab: {} ranks cannot be shared out among {} hosts", ranks, hosts),
        "give numbers of ranks that are multiples of the hosts");
  std::vector<std::string> words{netlab, "--hosts", std::to_string(hosts), "--ranks-per-host",
                                 std::to_string(ranks / hosts)};
  add_flags(point, words);
  const std::string mpi = value_of(point, "mpi"), osc = value_of(point, "osc");
  const bool is_open_mpi = mpi_library_version().find("Open MPI") != std::string::npos;
  const std::string launcher = mpi.empty() ? (is_open_mpi ? "openmpi" : "mpich") : mpi;
  words.insert(words.end(), {"--mpi", launcher});
  const std::string component = osc.empty() ? usual_osc(ranks / hosts) : osc;
  if (launcher == "openmpi" && !component.empty() && component != "default")
    words.insert(words.end(), {"--mca", "osc", component});
  words.emplace_back("--");
  return words;
}

}  // namespace barchan::app
