#include <barchan/app/report/frames.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <variant>

namespace barchan::app {
namespace {

/// A column's numbers; empty where there is none.
std::vector<double> numbers(const VtpPiece& piece, const char* name) {
  const VtpColumn* column = piece.find(name);
  if (column == nullptr) return {};
  return std::visit([](const auto& v) { return std::vector<double>(v.begin(), v.end()); },
                    column->values);
}

float size_of(const std::vector<double>& vectors, std::size_t i) {
  if (3 * i + 2 >= vectors.size()) return 0.0F;
  return static_cast<float>(std::hypot(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]));
}

std::uint8_t byte_of(const std::vector<double>& column, std::size_t i, double first) {
  return i < column.size() ? static_cast<std::uint8_t>(static_cast<int>(column[i] - first) & 0xff)
                           : std::uint8_t{0};
}

void add_piece(const VtpPiece& piece, Frame& frame) {
  frame.step = piece.step;
  const auto ids = numbers(piece, "id"), radii = numbers(piece, "radius"),
             types = numbers(piece, "type"), ranks = numbers(piece, "rank"),
             velocities = numbers(piece, "velocity"), spins = numbers(piece, "angular_velocity");
  for (std::size_t i = 0; i < piece.points.size() / 3; ++i) {
    Grain g{};
    g.id = i < ids.size() ? static_cast<std::int64_t>(ids[i]) : static_cast<std::int64_t>(i);
    for (std::size_t c = 0; c < 3; ++c) g.position[c] = static_cast<float>(piece.points[3 * i + c]);
    g.radius = i < radii.size() ? static_cast<float>(radii[i]) : 0.0F;
    g.speed = size_of(velocities, i);
    g.spin = size_of(spins, i);
    g.type = byte_of(types, i, 1.0);
    g.rank = byte_of(ranks, i, 0.0);
    frame.grains.push_back(g);
  }
}

std::vector<std::string> pieces_of(const std::string& path) {
  return path.ends_with(".pvtp") ? read_pvtp(path) : std::vector<std::string>{path};
}

}  // namespace

Frame read_frame(const std::string& folder, const PvdEntry& particles, const PvdEntry* bonds) {
  Frame frame;
  frame.time = particles.time;
  for (const std::string& piece : pieces_of(folder + particles.file))
    add_piece(read_vtp(piece), frame);
  std::sort(frame.grains.begin(), frame.grains.end(),
            [](const Grain& a, const Grain& b) { return a.id < b.id; });
  if (bonds == nullptr) return frame;
  for (const std::string& piece : pieces_of(folder + bonds->file)) {
    const VtpPiece lines = read_vtp(piece);
    for (const double x : lines.points) frame.bonds.push_back(static_cast<float>(x));
  }
  frame.hides_bonds = frame.bonds.size() > 6 * kMostBonds;
  if (frame.hides_bonds) frame.bonds.clear();
  return frame;
}

Frame frame_of(const LoadedDeck& loaded) {
  Frame frame;
  std::unordered_map<std::int64_t, const ParticleData*> by_id;
  for (const ParticleData& p : loaded.particles.particles) {
    by_id[p.id] = &p;
    Grain g{};
    g.id = p.id;
    for (int c = 0; c < 3; ++c)
      g.position[static_cast<std::size_t>(c)] = static_cast<float>(p.position[c]);
    g.radius = static_cast<float>(p.radius);
    g.speed = static_cast<float>(p.velocity.norm());
    g.spin = static_cast<float>(p.omega.norm());
    g.type = static_cast<std::uint8_t>(p.type);
    frame.grains.push_back(g);
  }
  frame.hides_bonds = loaded.particles.bonds.size() > kMostBonds;
  if (frame.hides_bonds) return frame;
  for (const BondData& bond : loaded.particles.bonds) {
    for (const std::int64_t id : {bond.id_a, bond.id_b}) {
      for (int c = 0; c < 3; ++c)
        frame.bonds.push_back(static_cast<float>(by_id.at(id)->position[c]));
    }
  }
  return frame;
}

}  // namespace barchan::app
