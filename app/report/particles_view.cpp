#include <barchan/app/report/particles_view.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <barchan/app/report/frames.hpp>
#include <barchan/core/base/error.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

constexpr std::size_t kBytesOfGrain = 11, kMostGrains = 1U << 20;

/// Of too many grains every k-th; k says how many stand for one.
std::size_t thin(std::vector<Frame>& frames) {
  std::size_t most = 0;
  for (const Frame& frame : frames) most = std::max(most, frame.grains.size());
  const std::size_t every = std::max<std::size_t>(1, (most + kMostGrains - 1) / kMostGrains);
  for (Frame& frame : frames) {
    std::erase_if(frame.grains, [&](const Grain& g) { return g.id % std::int64_t(every) != 0; });
  }
  return every;
}

struct Ranges {
  std::array<float, 3> lo{1e30F, 1e30F, 1e30F}, hi{-1e30F, -1e30F, -1e30F};
  float radius = 0.0F, speed = 0.0F, spin = 0.0F;
  int ranks = 0, types = 0;

  void take(const Grain& g) {
    for (std::size_t c = 0; c < 3; ++c) {
      lo[c] = std::min(lo[c], g.position[c] - g.radius);
      hi[c] = std::max(hi[c], g.position[c] + g.radius);
    }
    radius = std::max(radius, g.radius);
    speed = std::max(speed, g.speed);
    spin = std::max(spin, g.spin);
    ranks = std::max(ranks, g.rank + 1);
    types = std::max(types, g.type + 1);
  }
};

std::uint16_t part_of(float value, float lo, float hi) {
  if (!(hi > lo)) return 0;
  return static_cast<std::uint16_t>(
      std::lround(65535.0F * std::clamp((value - lo) / (hi - lo), 0.0F, 1.0F)));
}

PageData encoded_frame(const Frame& frame, const Ranges& ranges, int dimension,
                       const Frame* before) {
  std::vector<std::uint16_t> position, speed, spin, radius;
  std::vector<std::uint8_t> rank, type;
  for (const Grain& g : frame.grains) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(dimension); ++c)
      position.push_back(part_of(g.position[c], ranges.lo[c], ranges.hi[c]));
    speed.push_back(part_of(g.speed, 0.0F, ranges.speed));
    spin.push_back(part_of(g.spin, 0.0F, ranges.spin));
    radius.push_back(part_of(g.radius, 0.0F, ranges.radius));
    rank.push_back(g.rank);
    type.push_back(g.type);
  }
  PageData json{{"step", frame.step},       {"time", frame.time},
                {"n", frame.grains.size()}, {"position", encoded(position)},
                {"speed", encoded(speed)},  {"spin", encoded(spin)},
                {"rank", encoded(rank)}};
  const bool is_same = before != nullptr &&
                       std::equal(frame.grains.begin(), frame.grains.end(), before->grains.begin(),
                                  before->grains.end(), [](const Grain& a, const Grain& b) {
                                    return a.id == b.id && a.radius == b.radius;
                                  });
  if (!is_same) {
    json["radius"] = encoded(radius);
    json["type"] = encoded(type);
  }
  if (!frame.bonds.empty()) json["bonds"] = encoded(frame.bonds);
  return json;
}

/// A value of the deck such as domain.lo, or null.
PageData value_of(const PageData& deck, const std::string& key) {
  if (!deck.is_object() || !deck.contains(key) || !deck[key].is_string()) return nullptr;
  return parsed(deck[key].get<std::string>());
}

PageData view_of(const std::vector<Frame>& frames, const PageData& deck) {
  Ranges ranges;
  for (const Frame& frame : frames) {
    for (const Grain& g : frame.grains) ranges.take(g);
  }
  const PageData told = value_of(deck, "dimension");
  const bool is_flat = ranges.hi[2] - ranges.lo[2] <= 2.001F * ranges.radius;
  const int dimension = told.is_number() ? told.get<int>() : (is_flat ? 2 : 3);
  PageData view{{"dimension", dimension}};
  const auto corner = [&](const std::array<float, 3>& p) {
    PageData json = PageData::array();
    for (std::size_t c = 0; c < static_cast<std::size_t>(dimension); ++c) json.push_back(p[c]);
    return json;
  };
  view["lo"] = corner(ranges.lo);
  view["hi"] = corner(ranges.hi);
  const PageData lo = value_of(deck, "domain.lo"), hi = value_of(deck, "domain.hi");
  const bool has_domain = lo.is_array() && hi.is_array();
  view["box"] = {{"lo", has_domain ? lo : view["lo"]}, {"hi", has_domain ? hi : view["hi"]}};
  view["radius"] = ranges.radius;
  view["speed"] = ranges.speed;
  view["spin"] = ranges.spin;
  view["materials"] = view["ranks"] = view["frames"] = PageData::array();
  for (int t = 0; t < ranges.types; ++t) {
    const PageData name = value_of(deck, fmt::format("material.{}.name", t + 1));
    view["materials"].push_back(name.is_string() ? name
                                                 : PageData(fmt::format("material {}", t + 1)));
  }
  for (int r = 0; r < ranges.ranks; ++r) view["ranks"].push_back(fmt::format("rank {}", r));
  for (std::size_t f = 0; f < frames.size(); ++f)
    view["frames"].push_back(
        encoded_frame(frames[f], ranges, dimension, f > 0 ? &frames[f - 1] : nullptr));
  return view;
}

/// Of n snapshots those that are shown: the first, the last, and others evenly between.
std::vector<std::size_t> chosen(std::size_t n, std::size_t most) {
  std::vector<std::size_t> picked;
  const std::size_t count = std::min(n, std::max<std::size_t>(1, most));
  for (std::size_t k = 0; k < count; ++k)
    picked.push_back(count == 1 ? n - 1 : k * (n - 1) / (count - 1));
  return picked;
}

std::string note_of(const std::vector<Frame>& frames, std::size_t all, std::size_t every) {
  std::string note;
  if (frames.size() < all) note = fmt::format("Shown are {} of {} snapshots. ", frames.size(), all);
  if (every > 1) note += fmt::format("Of every {} particles one is shown. ", every);
  if (std::any_of(frames.begin(), frames.end(), [](const Frame& f) { return f.hides_bonds; }))
    note += fmt::format("Of more than {} bonds none is shown.", kMostBonds);
  return note;
}

}  // namespace

PageData snapshots_view(const std::string& folder, const PageData& deck,
                        const ViewOptions& options) {
  const std::string home = folder + "/snapshots/";
  if (!fs::exists(home + "run.pvd")) return {{"frames", PageData::array()}};
  const std::vector<PvdEntry> entries = read_pvd(home + "run.pvd");
  std::vector<const PvdEntry*> particles;
  std::map<double, const PvdEntry*> bonds;
  for (const PvdEntry& entry : entries) {
    if (entry.part == 0)
      particles.push_back(&entry);
    else
      bonds[entry.time] = &entry;
  }
  if (particles.empty()) return {{"frames", PageData::array()}};
  const auto read = [&](const PvdEntry& entry) {
    const auto with = bonds.find(entry.time);
    return read_frame(home, entry, with == bonds.end() ? nullptr : with->second);
  };
  Frame last = read(*particles.back());
  const std::size_t bytes = kBytesOfGrain * std::min(last.grains.size() + 1, kMostGrains);
  const auto picked =
      chosen(particles.size(), std::min(static_cast<std::size_t>(std::max(1, options.most_frames)),
                                        options.most_bytes / bytes));
  std::vector<Frame> all;  // in the order of time, the last one last
  for (const std::size_t k : picked)
    all.push_back(k + 1 == particles.size() ? std::move(last) : read(*particles[k]));
  const std::size_t every = thin(all);
  PageData view = view_of(all, deck);
  view["note"] = note_of(all, particles.size(), every);
  return view;
}

PageData deck_view(const LoadedDeck& loaded) {
  std::vector<Frame> frames{frame_of(loaded)};
  const std::size_t every = thin(frames);
  PageData deck = PageData::object();
  for (const auto& [key, value] : loaded.deck.keys) deck[key] = value;
  PageData view = view_of(frames, deck);
  view["ranks"] = PageData::array();  // nobody owns them yet
  view["note"] = note_of(frames, 1, every);
  return view;
}

}  // namespace barchan::app
