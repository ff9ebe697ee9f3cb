#include <barchan/core/generators/check_walls.hpp>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/vec_text.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/search/grid.hpp>

namespace barchan {
namespace {

constexpr const char* kRemedy = "move the particle or the wall: at most half a radius may overlap";

/// Calls found(text) for every particle that lies in a wall where it stands at the start.
template <int Dim, class Found>
void for_each_intruder(const Model& model, const WallSpec& wall, const ParticleSet& set,
                       Found&& found) {
  const WallShape<Dim> shape(wall, periodic_box(model.domain, Dim));
  for (const ParticleData& p : set.particles) {
    const WallFoot foot = shape.foot(wall.point, p.position.data());
    if (const auto what = intrusion(wall, foot, p, Dim)) found(p, *what);
  }
}

template <class Found>
void for_each_intruder(const Model& model, const WallSpec& wall, const ParticleSet& set,
                       Found&& found) {
  if (model.dimension == 2)
    for_each_intruder<2>(model, wall, set, found);
  else
    for_each_intruder<3>(model, wall, set, found);
}

SourcePlace place_of(const Model& model, const WallSpec& wall) {
  return wall.place.file.empty() ? SourcePlace{model.deck_file, 0, 0} : wall.place;
}

}  // namespace

std::optional<std::string> intrusion(const WallSpec& wall, const WallFoot& foot,
                                     const ParticleData& particle, int dimension) {
  if (particle.fixed && !wall.is_loaded) return std::nullopt;
  const double overlap = particle.radius - foot.distance;
  if (!(overlap > kGrossOverlap * particle.radius)) return std::nullopt;
  const std::string who =
      fmt::format("particle {} at {}", particle.id, in_brackets(particle.position, dimension));
  if (foot.distance <= 0.0)
    return fmt::format("{} has its centre {} wall '{}'", who, foot.distance < 0.0 ? "behind" : "on",
                       wall.name);
  return fmt::format("{} reaches into wall '{}' by {:.0f} % of its radius", who, wall.name,
                     100.0 * overlap / particle.radius);
}

void check_walls(const Model& model, const ParticleSet& set) {
  for (const WallSpec& wall : model.walls) {
    for_each_intruder(model, wall, set, [&](const ParticleData& p, const std::string& what) {
      if (wall.from_stage <= 0 || p.fixed) throw InputError(place_of(model, wall), what, kRemedy);
    });
  }
}

std::vector<std::string> walls_to_come_in_particles(const Model& model, const ParticleSet& set) {
  std::vector<std::string> found;
  for (const WallSpec& wall : model.walls) {
    if (wall.from_stage <= 0) continue;
    std::int64_t count = 0;
    std::string first;
    for_each_intruder(model, wall, set, [&](const ParticleData&, const std::string& what) {
      if (++count == 1) first = what;
    });
    if (count == 0) continue;
    found.push_back(
        fmt::format("wall '{}' appears with stage '{}', and would end the run if nothing had moved "
                    "by then: {}{}",
                    wall.name, model.stages[static_cast<std::size_t>(wall.from_stage)].name, first,
                    count == 1 ? "" : fmt::format(", and {} more", count - 1)));
  }
  return found;
}

}  // namespace barchan
