#include <barchan/core/checkpoint/state.hpp>

#include <xxhash.h>

#include <cmath>
#include <string_view>

#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/brick/world.hpp>

namespace barchan {
namespace {

constexpr std::array<std::string_view, 9> kParts{"dimension and domain",
                                                 "time.step",
                                                 "gravity",
                                                 "material",
                                                 "contact and pair",
                                                 "bond",
                                                 "wall",
                                                 "stage",
                                                 "heat"};

[[noreturn]] void refuse(const std::string& file, const std::string& what,
                         const std::string& remedy) {
  throw InputError(SourcePlace{file, 0, 0}, what, remedy);
}

CheckpointState take_state(ByteReader& in) {
  CheckpointState s;
  s.step = in.take<std::int64_t>();
  s.stage_begin = in.take<std::int64_t>();
  s.stage = in.take<std::int32_t>();
  s.skin = in.take<double>();
  s.reach = in.take<double>();
  s.grain = in.take<double>();
  s.heat_grain = in.take<double>();
  s.overlap_limit = in.take<double>();
  s.start_particles = in.take<std::int64_t>();
  s.has_bonds = in.take<std::uint8_t>() != 0;
  s.num_particles = in.take<std::int64_t>();
  s.look = in.take<PendingLook>();
  s.seen_overlap = in.take<double>();
  s.left = in.take<LeftDomain>();
  s.walls = in.take_counted<SavedWall>();
  s.fingerprint = in.take_counted<std::uint64_t>();
  if (!in.empty()) {
    s.since = in.take<TimePoint>();
    s.stage_since = in.take<TimePoint>();
    s.last_dt = in.take<double>();
  }
  if (!in.empty()) s.fields = in.take_counted<CallerField::Saved>();
  in.finish();
  return s;
}

void put(ByteWriter& out, const Vec3& v) {
  for (int c = 0; c < 3; ++c) out.put(v[c]);
}

void put_contacts(ByteWriter& out, const ContactTable& table) {
  out.put(table.no_tension);
  with_law(table.law, [&]<class Law>(Law /*law*/) {
    out.put(table.law), out.put(table.tangential), out.put(table.twisting), out.put(table.adhesion),
        out.put(table.pull_off);
    for (const typename Law::Pair& pair : table.constants)
      Law::for_each_number(pair, [&](const char* /*key*/, double value) { out.put(value); });
  });
}

void put_bonds(ByteWriter& out, const std::vector<BondLaw>& laws) {
  for (const BondLaw& b : laws) {
    for (const double value : {b.young_modulus, b.stiffness_ratio, b.radius_factor, b.damping_ratio,
                               b.normal_stiffness, b.tensile_strength, b.shear_strength}) {
      out.put(value);
    }
  }
}

void put_walls(ByteWriter& out, const std::vector<WallSpec>& walls) {
  for (const WallSpec& w : walls) {
    out.put(w.kind);
    out.put(w.material);
    for (const Vec3& v : {w.point, w.normal, w.velocity}) put(out, v);
    for (const double value : {w.width, w.depth, w.load, w.mass, w.damping}) out.put(value);
    out.put(w.is_loaded);
    out.put(w.from_stage);
  }
}

void put_heat(ByteWriter& out, const Model& model) {
  out.put(model.heat.is_on);
  if (!model.heat.is_on) return;
  out.put(model.heat.temperature);
  out.put(model.heat.dissipation);
  for (const Material& m : model.materials) out.put(m.conductivity), out.put(m.heat_capacity);
  for (const WallSpec& w : model.walls) {
    out.put(w.temperature.has_value());
    out.put(w.temperature.value_or(0.0));
    out.put(w.heat_flux.value_or(0.0));
  }
}

template <class Put>
std::uint64_t hash_of(Put&& put_part) {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  put_part(out);
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace

int num_carried(const CheckpointState& state) {
  int sum = 0;
  for (const CallerField::Saved& field : state.fields) sum += field.components;
  return sum;
}

std::vector<std::byte> encode(const CheckpointState& s) {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  out.put(s.step);
  out.put(s.stage_begin);
  out.put(s.stage);
  out.put(s.skin);
  out.put(s.reach);
  out.put(s.grain);
  out.put(s.heat_grain);
  out.put(s.overlap_limit);
  out.put(s.start_particles);
  out.put(static_cast<std::uint8_t>(s.has_bonds));
  out.put(s.num_particles);
  out.put(s.look);
  out.put(s.seen_overlap);
  out.put(s.left);
  out.put_counted(s.walls);
  out.put_counted(s.fingerprint);
  if (s.last_dt > 0.0 || !s.fields.empty()) {
    out.put(s.since);
    out.put(s.stage_since);
    out.put(s.last_dt);
  }
  if (!s.fields.empty()) out.put_counted(s.fields);
  return bytes;
}

CheckpointState decode_state(std::span<const std::byte> bytes, const std::string& file) {
  CheckpointState state;
  try {
    ByteReader in(bytes);
    state = take_state(in);
  } catch (const RunError& e) {
    refuse(file, std::string("the state is not valid: ") + e.what(), "take another checkpoint");
  }
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  const auto is_before = [&](const TimePoint& p) {
    return std::isfinite(p.time) && p.step >= 0 && p.step <= state.step;
  };
  const bool is_sane =
      state.step >= 0 && state.stage >= 0 && state.stage_begin >= 0 &&
      state.stage_begin <= state.step && state.skin >= 0.0 && std::isfinite(state.skin) &&
      positive(state.reach) && state.start_particles >= 0 && positive(state.grain) &&
      positive(state.heat_grain) && state.overlap_limit > 0.0 && state.look.step >= -1 &&
      state.seen_overlap >= 0.0 && state.look.step <= state.step &&
      (state.look.step < 0 || state.step - state.look.step < kEventSteps) &&
      is_before(state.since) && is_before(state.stage_since) && state.last_dt >= 0.0 &&
      std::isfinite(state.last_dt) && CallerFields().restore(state.fields);
  if (!is_sane) refuse(file, "the state is not valid", "take another checkpoint");
  return state;
}

std::vector<std::uint64_t> fingerprint(const Model& model) {
  return {
      hash_of([&](ByteWriter& out) {
        out.put(model.dimension);
        put(out, model.domain.lo);
        put(out, model.domain.hi);
        out.put(model.domain.periodic);
        out.put(model.domain.strip_axis);
      }),
      hash_of([&](ByteWriter& out) { out.put(model.time.step); }),
      hash_of([&](ByteWriter& out) { put(out, model.gravity); }),
      hash_of([&](ByteWriter& out) {
        for (const Material& m : model.materials) out.put(m.density);
      }),
      hash_of([&](ByteWriter& out) { put_contacts(out, model.contacts); }),
      hash_of([&](ByteWriter& out) { put_bonds(out, model.bond_laws); }),
      hash_of([&](ByteWriter& out) { put_walls(out, model.walls); }),
      hash_of([&](ByteWriter& out) {
        for (const Stage& s : model.stages) {
          out.put(s.local_damping);
          if (&s == &model.stages.back()) break;  // its end is that of the run, which may change
          out.put(s.max_time);
          out.put(s.kinetic_ratio);
        }
      }),
      hash_of([&](ByteWriter& out) { put_heat(out, model); }),
  };
}

void check_same_model(const CheckpointState& state, const Model& model, const std::string& file) {
  const std::vector<std::uint64_t> mine = fingerprint(model);
  std::string differences;
  for (std::size_t p = 0; p < kParts.size(); ++p) {
    const bool is_same = state.fingerprint.size() == mine.size() && state.fingerprint[p] == mine[p];
    if (!is_same) differences += (differences.empty() ? "" : ", ") + std::string(kParts[p]);
  }
  if (!differences.empty()) {
    refuse(
        file, "the checkpoint is of another deck, which differs in: " + differences,
        "restart with the deck and --set options of that run; its length and outputs may change");
  }
  if (state.walls.size() != model.walls.size() ||
      static_cast<std::size_t>(state.stage) >= model.stages.size()) {
    refuse(file, "the state does not fit the deck", "take another checkpoint");
  }
}

}  // namespace barchan
