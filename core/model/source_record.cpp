#include <barchan/core/model/source_record.hpp>

#include <xxhash.h>

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/model/particle_source.hpp>

namespace barchan {
namespace {

/// A hash that grows number by number, free of padding.
class Hash {
 public:
  Hash() : state_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(state_.get()); }
  template <class T>
  void add(const T& value) {
    XXH3_64bits_update(state_.get(), &value, sizeof value);
  }
  void add(const Vec3& v) {
    for (int c = 0; c < 3; ++c) add(v[c]);
  }
  void add(const ParticleData& p) {
    add(p.id);
    add(p.type);
    add(p.radius);
    add(p.density);
    for (const Vec3& v : {p.position, p.velocity, p.omega}) add(v);
    add(static_cast<std::uint8_t>(p.fixed));
  }
  void add(const BondData& b) {
    add(b.id_a);
    add(b.id_b);
    add(b.law);
    add(b.length);
    add(b.shear);
    add(b.bending);
    add(b.twisting);
  }
  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

/// Bonds go with the source of their lower id.
void add_bonds(const ParticleSet& made, std::span<const std::size_t> begins,
               std::vector<Hash>& hashes) {
  if (made.bonds.empty()) return;
  std::vector<std::pair<std::int64_t, std::size_t>> source_of;
  for (std::size_t s = 0; s < hashes.size(); ++s) {
    for (std::size_t i = begins[s]; i < begins[s + 1]; ++i)
      source_of.emplace_back(made.particles[i].id, s);
  }
  std::sort(source_of.begin(), source_of.end());
  for (const BondData& bond : made.bonds) {
    const auto it =
        std::lower_bound(source_of.begin(), source_of.end(), std::pair{bond.id_a, std::size_t{0}});
    if (it == source_of.end()) continue;
    Hash& hash = hashes[it->second];
    hash.add(bond);
  }
}

const std::string* value_of(const SourceRecord& record, const std::string& key) {
  const auto it = std::find_if(record.keys.begin(), record.keys.end(),
                               [&](const SourceKey& k) { return k.key == key; });
  return it == record.keys.end() ? nullptr : &it->value;
}

std::string name_of(const SourceRecord& record, std::size_t number) {
  return fmt::format("[[particles]] {} ({}{})", number + 1, record.kind,
                     record.line > 0 ? fmt::format(", line {}", record.line) : "");
}

/// The keys that differ, each with its old and new value.
std::string key_differences(const SourceRecord& saved, const SourceRecord& now) {
  std::vector<std::string> all;
  for (const SourceKey& k : saved.keys) {
    const std::string* value = value_of(now, k.key);
    if (value == nullptr)
      all.push_back(fmt::format("{} was {} and is not given", k.key, k.value));
    else if (*value != k.value)
      all.push_back(fmt::format("{} was {} and is {}", k.key, k.value, *value));
  }
  for (const SourceKey& k : now.keys) {
    if (value_of(saved, k.key) == nullptr)
      all.push_back(fmt::format("{} was not given and is {}", k.key, k.value));
  }
  constexpr std::size_t kMost = 6;
  const std::size_t more = all.size() - std::min(all.size(), kMost);
  all.resize(all.size() - more);
  return fmt::format("{}{}", fmt::join(all, ", "),
                     more == 0 ? "" : fmt::format(" and {} more keys differ", more));
}

std::string difference(const SourceRecord& saved, const SourceRecord& now) {
  if (saved.hash == now.hash) return {};
  if (saved.kind != now.kind) return fmt::format("kind was {} and is {}", saved.kind, now.kind);
  std::string keys = key_differences(saved, now);
  const std::string* path = value_of(now, "path");
  if (keys.empty() && path != nullptr) return fmt::format("the contents of {} differ", *path);
  return keys;
}

/// Lists of different length: what is gone and what was added, taking the first that fits for the
/// same.
std::vector<std::string> other_tables(std::span<const SourceRecord> saved,
                                      std::span<const SourceRecord> now) {
  std::vector<std::string> all;
  std::size_t next = 0;
  for (std::size_t s = 0; s < saved.size(); ++s) {
    std::size_t n = next;
    while (n < now.size() && saved[s].keys != now[n].keys) ++n;
    if (n == now.size()) {
      all.push_back(name_of({saved[s].kind, 0, {}, 0}, s) + " of the checkpoint is gone");
      continue;
    }
    for (; next < n; ++next) all.push_back(name_of(now[next], next) + " was added");
    ++next;
  }
  for (; next < now.size(); ++next) all.push_back(name_of(now[next], next) + " was added");
  return all;
}

}  // namespace

std::vector<SourceRecord> make_records(std::span<const ParticleSource> sources,
                                       const ParticleSet& made,
                                       std::span<const std::size_t> begins) {
  std::vector<Hash> hashes(sources.size());
  for (std::size_t s = 0; s < sources.size(); ++s) {
    for (std::size_t i = begins[s]; i < begins[s + 1]; ++i) hashes[s].add(made.particles[i]);
  }
  add_bonds(made, begins, hashes);
  std::vector<SourceRecord> records;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    records.push_back(sources[s].record);
    records.back().hash = hashes[s].value();
  }
  return records;
}

std::string source_differences(std::span<const SourceRecord> saved,
                               std::span<const SourceRecord> now) {
  if (saved.empty() || now.empty()) return {};
  std::vector<std::string> all;
  if (saved.size() != now.size()) {
    all = other_tables(saved, now);
  } else {
    for (std::size_t s = 0; s < now.size(); ++s) {
      const std::string what = difference(saved[s], now[s]);
      if (!what.empty()) all.push_back(name_of(now[s], s) + ": " + what);
    }
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace barchan
