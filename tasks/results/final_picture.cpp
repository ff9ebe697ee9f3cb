#include <barchan/tasks/results/final_picture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <barchan/core/io/picture.hpp>
#include <barchan/tasks/agree.hpp>

namespace barchan {
namespace {

constexpr double kMostImages = 8.0;  ///< of a plate that are drawn, to either side

struct Seen {
  double x, y, z, radius, speed;
  std::int32_t type, unused;
};

std::vector<std::byte> seen_here(const Simulation& simulation) {
  std::vector<Seen> seen;
  simulation.for_each_owned([&](const OwnedParticle& p) {
    seen.push_back(
        {p.position.x(), p.position.y(), p.position.z(), p.radius, p.velocity.norm(), p.type, 0});
  });
  const auto bytes = std::as_bytes(std::span<const Seen>(seen));
  return {bytes.begin(), bytes.end()};
}

/// What a picture needs, piece by piece.
struct Scene {
  std::vector<Vec3> positions;
  std::vector<double> radii, speeds, kinds;

  void add(const std::vector<std::byte>& bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(Seen)) {
      Seen p{};
      std::memcpy(&p, bytes.data() + at, sizeof(Seen));
      positions.emplace_back(p.x, p.y, p.z);
      radii.push_back(p.radius);
      speeds.push_back(p.speed);
      kinds.push_back(p.type);
    }
  }
};

struct Window {
  const Domain& domain;
  int up;  ///< the axis across x
};

/// A straight line, `half` to either side of a point.
struct Stretch {
  Vec3 point, along;
  double half;
};

/// What of a line lies in the window. @param clips  along which axes
void add_clipped(const Window& window, const std::array<bool, 3>& clips, const Stretch& line,
                 std::vector<PictureLine>& lines) {
  const auto& [domain, up] = window;
  const auto& [point, along, half] = line;
  double lo = -half, hi = half;
  for (const int axis : {0, up}) {
    if (!clips[static_cast<std::size_t>(axis)]) continue;
    const double a = domain.lo[axis] - point[axis], b = domain.hi[axis] - point[axis];
    if (std::fabs(along[axis]) < 1e-12) {
      const double slack = 1e-9 * (b - a);
      if (a > slack || b < -slack) return;
      continue;
    }
    const double t0 = a / along[axis], t1 = b / along[axis];
    lo = std::max(lo, std::min(t0, t1));
    hi = std::min(hi, std::max(t0, t1));
  }
  if (lo < hi) lines.push_back({point + lo * along, point + hi * along});
}

/// A plate and those of its images that reach into the domain.
void add_images(const Window& window, const Stretch& plate, std::vector<PictureLine>& lines) {
  const Domain& domain = window.domain;
  const Vec3 length = domain.hi - domain.lo;
  const auto images_along = [&](int axis) {
    std::vector<double> shifts{0.0};
    if (!domain.periodic[static_cast<std::size_t>(axis)]) return shifts;
    const double home = -std::floor((plate.point[axis] - domain.lo[axis]) / length[axis]);
    const double reach =
        std::min(kMostImages, std::ceil(std::fabs(plate.along[axis]) * plate.half / length[axis]));
    shifts.clear();
    for (double k = home - reach; k <= home + reach; ++k) shifts.push_back(k * length[axis]);
    return shifts;
  };
  for (const double x : images_along(0)) {
    for (const double y : images_along(window.up)) {
      Stretch image = plate;
      image.point.x() += x;
      image.point[window.up] += y;
      add_clipped(window, domain.periodic, image, lines);
    }
  }
}

std::vector<PictureLine> wall_lines(const Simulation& simulation) {
  const Model& model = simulation.model();
  const int up = model.dimension == 2 ? 1 : 2;
  std::vector<PictureLine> lines;
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const WallSpec& spec = model.walls[w];
    const WallState& state = simulation.walls()[w];
    if (!state.is_active || std::hypot(spec.normal.x(), spec.normal[up]) < 0.999)
      continue;  // seen edge-on only
    Vec3 along = Vec3::Zero();
    along.x() = -spec.normal[up];
    along[up] = spec.normal.x();
    if (spec.kind == WallKind::Plane) {
      add_clipped({model.domain, up}, {true, true, true}, {state.point, along, 1e300}, lines);
    } else {
      // An upright plate in 3D has its width along the line of sight.
      const bool is_upright = model.dimension == 3 && std::fabs(spec.normal.x()) > 0.5;
      const double half = 0.5 * (is_upright ? spec.depth : spec.width);
      add_images({model.domain, up}, {state.point, along, half}, lines);
    }
  }
  return lines;
}

void draw(const Simulation& simulation, const Scene& scene, const std::string& path) {
  const Model& model = simulation.model();
  PictureInput input;
  input.dimension = model.dimension;
  input.lo = model.domain.lo;
  input.hi = model.domain.hi;
  input.positions = scene.positions;
  input.radii = scene.radii;
  const bool is_mixed = std::any_of(scene.kinds.begin(), scene.kinds.end(),
                                    [&](double k) { return k != scene.kinds.front(); });
  input.values = is_mixed ? scene.kinds : scene.speeds;
  input.values_are_kinds = is_mixed;
  if (is_mixed) {
    for (const Material& material : model.materials) input.kinds.push_back(material.name);
  }
  input.label = "speed [m/s]";
  input.title = fmt::format("{}{}t = {:.4g} s", model.title, model.title.empty() ? "" : ", ",
                            simulation.time());
  input.lines = wall_lines(simulation);
  write_picture(path, input);
}

}  // namespace

void write_final_picture(const Simulation& simulation, const std::string& path) {
  const auto pieces = simulation.communicator().gather(seen_here(simulation));
  agree(simulation.communicator(), [&] {
    if (!simulation.communicator().is_root()) return;
    Scene scene;
    for (const auto& piece : pieces) scene.add(piece);
    draw(simulation, scene, path);
  });
}

}  // namespace barchan
