#include <barchan/app/experiments/comparison.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

constexpr double kLeastConfidence = 0.85;  // below it, an interval says nothing
constexpr double kLeastShare = 0.0005;     // of a step, for a part to be worth a line

std::string word(const Json& json) {
  if (json.is_null()) return "–";
  return json.is_string() ? json.get<std::string>() : compact_text(json);
}

Json at(const Json& json, const std::string& pointer) {
  const Json::json_pointer path(pointer);
  return json.contains(path) ? json.at(path) : Json();
}

void set_ratio(PointPair& pair, double confidence) {
  if (!pair.are_paired) {
    pair.ratio = unpaired_ratio(steps_of(pair.a), steps_of(pair.b), confidence);
    return;
  }
  std::vector<std::pair<double, double>> steps;
  for (const Measurement* a : pair.a) {
    for (const Measurement* b : pair.b) {
      if (a->repetition == b->repetition) steps.emplace_back(a->step(), b->step());
    }
  }
  pair.ratio = paired_ratio(steps, confidence);
}

bool share_repetition(const PointPair& pair) {
  return std::any_of(pair.a.begin(), pair.a.end(), [&](const Measurement* a) {
    return std::any_of(pair.b.begin(), pair.b.end(),
                       [&](const Measurement* b) { return a->repetition == b->repetition; });
  });
}

PointPair pair_of(const Selection& a, const Point& at_a, const Selection& b, const Point& at_b,
                  double confidence) {
  PointPair pair;
  for (const AxisValue& value : at_a) {
    if (has(at_b, {value})) pair.point.push_back(value);
  }
  pair.a = a.experiment.of(at_a);
  pair.b = b.experiment.of(at_b);
  std::error_code failed;
  pair.are_paired = !a.experiment.sweep.is_null() &&
                    fs::equivalent(a.experiment.path, b.experiment.path, failed) &&
                    share_repetition(pair);
  set_ratio(pair, confidence);
  return pair;
}

}  // namespace

std::string PointPair::verdict() const {
  if (ratio.confidence < kLeastConfidence) return "too few runs to tell";
  if (ratio.holds(1.0)) return "no difference seen";
  return fmt::format("{:.1f} % {}", 100.0 * std::abs(ratio.value - 1.0),
                     ratio.value > 1.0 ? "slower" : "faster");
}

std::vector<PointPair> match(const Selection& a, const Selection& b, double confidence) {
  const std::vector<Point> points_a = a.experiment.points(), points_b = b.experiment.points();
  std::vector<PointPair> pairs;
  if (points_a.size() == 1 && points_b.size() == 1)
    return {pair_of(a, points_a.front(), b, points_b.front(), confidence)};
  const auto rest = [&](const Point& point) { return without(without(point, a.values), b.values); };
  for (const Point& at_a : points_a) {
    for (const Point& at_b : points_b) {
      if (rest(at_a) == rest(at_b)) pairs.push_back(pair_of(a, at_a, b, at_b, confidence));
    }
  }
  if (pairs.empty())
    throw InputError("no point of the one is a point of the other",
                     "select points that differ along the axes that you name, such as "
                     "DIR:exchange=isend DIR:exchange=get");
  return pairs;
}

std::vector<Difference> differences(const Json& a, const Json& b) {
  static constexpr const char* kKeys[] = {"version",
                                          "deck",
                                          "title",
                                          "particles",
                                          "steps",
                                          "dt",
                                          "ranks",
                                          "threads",
                                          "exchange",
                                          "schedule",
                                          "progress",
                                          "contact_search",
                                          "transport",
                                          "vector",
                                          "skin",
                                          "rebuilds",
                                          "machine/host",
                                          "machine/hosts",
                                          "machine/processor",
                                          "machine/cores",
                                          "machine/mpi",
                                          "state_digest"};
  std::vector<Difference> found;
  for (const std::string key : kKeys) {
    const Json one = at(a, "/" + key), other = at(b, "/" + key);
    if (one != other) found.push_back({key, word(one), word(other)});
  }
  std::set<std::string> keys;
  for (const Json* run : {&a, &b}) {
    const Json of_deck = run->value("deck_keys", Json::object());
    for (const auto& [key, value] : of_deck.items()) keys.insert(key);
  }
  for (const std::string& key : keys) {
    const Json one = a.value("deck_keys", Json::object()).value(key, Json()),
               other = b.value("deck_keys", Json::object()).value(key, Json());
    if (one != other) found.push_back({"deck: " + key, word(one), word(other)});
  }
  return found;
}

std::vector<PartTimes> parts_of(const PointPair& pair) {
  std::set<std::string> names;
  for (const auto* runs : {&pair.a, &pair.b}) {
    for (const Measurement* m : *runs) {
      const Json phases = m->run.value("phases", Json::object());
      for (const auto& [name, value] : phases.items()) names.insert(name);
    }
  }
  const auto middle = [](const std::vector<const Measurement*>& runs, const std::string& path) {
    return median(figures_of(runs, [&](const Measurement& m) {
      const Json seconds = at(m.run, path);
      return seconds.is_number() ? m.per_step(seconds.get<double>()) : 0.0;
    }));
  };
  std::vector<PartTimes> parts;
  for (const std::string& name : names)
    parts.push_back({name, middle(pair.a, "/phases/" + name), middle(pair.b, "/phases/" + name)});
  double sum = 0.0;
  for (const PartTimes& part : parts) sum += part.a;
  std::erase_if(
      parts, [&](const PartTimes& part) { return std::max(part.a, part.b) < kLeastShare * sum; });
  std::stable_sort(parts.begin(), parts.end(),
                   [](const PartTimes& x, const PartTimes& y) { return x.a > y.a; });
  for (const char* key : {"in_flight_seconds", "exposed_seconds"}) {
    const std::string path = std::string("/communication/") + key;
    parts.push_back({std::string("communication, ") + (key[0] == 'i' ? "in flight" : "exposed"),
                     middle(pair.a, path), middle(pair.b, path)});
  }
  return parts;
}

}  // namespace barchan::app
