#include <barchan/tasks/cut_shape.hpp>

#include <algorithm>
#include <charconv>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include <barchan/comm/topology/strips.hpp>
#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

// In steps of a particle (docs/measurements/performance.md).
constexpr double kGhost = 0.35;     ///< a ghost and its pairs
constexpr double kMessage = 100.0;  ///< to another rank
constexpr double kHandOver = 10.0;  ///< to a lane of the same rank
/// Strips hide a halo behind the other cut's work, and have fewer messages.
constexpr double kClearlyBetter = 0.9;

constexpr double kDoesNotFit = std::numeric_limits<double>::infinity();

using Shape = std::array<int, 3>;

/// All ways to write a number as a product along the axes that there are.
std::vector<Shape> products(int number, int dimension) {
  std::vector<Shape> found;
  for (int a = 1; a <= number; ++a) {
    if (number % a != 0) continue;
    for (int b = 1; b <= number / a; ++b) {
      if (number / a % b != 0) continue;
      const int c = number / a / b;
      if (dimension == 3 || c == 1) found.push_back({a, b, c});
    }
  }
  return found;
}

bool fits(const CutShape& shape, const CutRoom& room) {
  if (shape.form == CutForm::Strips) return shape.along(0) <= room.most_strips(min_cells(shape));
  for (int k = 0; k < 3; ++k) {
    if (shape.along(k) > room.cells[static_cast<std::size_t>(k)]) return false;
  }
  return true;
}

struct Choice {
  CutShape shape;
  double step = kDoesNotFit;

  void take(const CutShape& other, const CutRoom& room) {
    if (!fits(other, room)) return;
    const double its = predicted_step(other, room);
    if (its < step) shape = other, step = its;
  }
};

/// As many lanes as threads, where they fit, else fewer.
Choice best_strips(const CutRequest& request, const CutRoom& room) {
  Choice best;
  CutShape shape{CutForm::Strips, {request.ranks, 1, 1}, {1, 1, 1}, 0};
  if (request.ranks > 1) shape.depth = request.depth;
  const int fit = room.most_strips(min_cells(shape)) / request.ranks;
  if (fit < 1) return best;
  shape.lanes[0] = std::clamp(request.threads, 1, fit);
  best.take(shape, room);
  return best;
}

Choice best_bricks(const CutRequest& request, const CutRoom& room, std::span<const Shape> ranks) {
  Choice best;
  for (int threads = request.threads; threads >= 1 && best.step == kDoesNotFit; --threads) {
    for (const Shape& of_ranks : ranks) {
      for (const Shape& lanes : products(threads, room.dimension))
        best.take({CutForm::Bricks, of_ranks, lanes}, room);
    }
  }
  return best;
}

std::string in_words(const Shape& shape, int dimension) {
  return dimension == 3 ? fmt::format("[{}, {}, {}]", shape[0], shape[1], shape[2])
                        : fmt::format("[{}, {}]", shape[0], shape[1]);
}

/// By axes of the deck, into those of the grid.
Shape in_grid_order(const Shape& xyz, const CutRoom& room) {
  Shape shape{1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) shape[k] = xyz[static_cast<std::size_t>(room.axes[k])];
  return shape;
}

/// In any shape, of one thread a rank.
Choice as_bricks(int ranks, const CutRoom& room) {
  return best_bricks({{}, ranks, 1, false, {}}, room, products(ranks, room.dimension));
}

/// Up to as many as were asked for; 0: not even one fits.
int most_ranks_as_bricks(int ranks, const CutRoom& room) {
  while (ranks > 0 && as_bricks(ranks, room).step == kDoesNotFit) --ranks;
  return ranks;
}

/// What a user may do instead.
std::string remedy(const CutRequest& request, const CutRoom& room) {
  const Choice bricks = as_bricks(request.ranks, room);
  if (bricks.step < kDoesNotFit && !request.needs_strips)
    return fmt::format("for {} ranks cuts = {} would fit, or \"auto\"", request.ranks,
                       in_words(along_xyz(bricks.shape.ranks, room), room.dimension));
  const bool may_be_bricks = !request.needs_strips && request.wish.kind == CutWish::Kind::Auto;
  const int most =
      std::max(room.most_strips(), may_be_bricks ? most_ranks_as_bricks(request.ranks, room) : 0);
  if (request.needs_strips && request.ranks <= most)
    return "use cuts = \"strips\", or another exchange";
  return fmt::format("use at most {} rank{}{}", most, most == 1 ? "" : "s",
                     request.needs_strips ? ", or another exchange" : "");
}

[[noreturn]] void refuse(const CutRequest& request, const CutRoom& room, const std::string& what) {
  const SourcePlace& place = request.wish.place.file.empty() ? request.place : request.wish.place;
  throw InputError(place, what, remedy(request, room));
}

CutShape as_asked(const CutRequest& request, const CutRoom& room) {
  const Shape& xyz = request.wish.bricks;
  const std::string words = in_words(xyz, room.dimension);
  if (room.dimension == 2 && xyz[2] != 1)
    refuse(request, room,
           fmt::format("cuts ask for {} bricks along z, but the run has two dimensions", xyz[2]));
  const std::int64_t product = std::int64_t{xyz[0]} * xyz[1] * xyz[2];
  if (product != request.ranks)
    refuse(request, room,
           fmt::format("cuts = {} make {} brick{} for {} rank{}", words, product,
                       product == 1 ? "" : "s", request.ranks, request.ranks == 1 ? "" : "s"));
  const Shape ranks = in_grid_order(xyz, room);
  for (std::size_t k = 0; k < 3; ++k) {
    if (ranks[k] <= room.cells[k]) continue;
    refuse(
        request, room,
        fmt::format("cuts = {}: {} bricks along {}, where the domain has {} cell{}", words,
                    ranks[k], "xyz"[room.axes[k]], room.cells[k], room.cells[k] == 1 ? "" : "s"));
  }
  // Along the strip axis alone they are strips, where these fit.
  if (ranks[1] == 1 && ranks[2] == 1) {
    const Choice strips = best_strips(request, room);
    if (strips.step < kDoesNotFit && strips.shape.num_lanes() == request.threads)
      return strips.shape;
  }
  if (request.needs_strips)
    refuse(request, room,
           fmt::format("exchange 'return' works on strips, not with cuts = {}", words));
  return best_bricks(request, room, std::span(&ranks, 1)).shape;
}

/// Shadows lie beyond cuts along one axis.
CutShape with_shadows(const CutRequest& request, const CutRoom& room) {
  CutRequest flat = request;
  flat.depth = 0;
  const CutShape shape =
      request.wish.kind == CutWish::Kind::Bricks ? as_asked(flat, room) : CutShape{};
  if (shape.form == CutForm::Bricks)
    throw InputError(request.depth_place,
                     fmt::format("a depth of {} works on strips, not with cuts = {}", request.depth,
                                 in_words(request.wish.bricks, room.dimension)),
                     "use cuts = \"strips\", or a depth of 0");
  const Choice strips = best_strips(request, room);
  if (strips.step < kDoesNotFit) return strips.shape;
  const int most = most_depth(request.ranks, room);
  throw InputError(
      request.depth_place,
      fmt::format("a depth of {} needs strips of {} cells: {} ranks do not fit into {} cells "
                  "along {}",
                  request.depth, request.depth + kMinSlabs, request.ranks, room.cells[0],
                  "xyz"[room.axes[0]]),
      most > 0 ? fmt::format("use a depth of at most {}, or fewer ranks", most)
               : "use fewer ranks, or a depth of 0");
}

}  // namespace

int CutRoom::most_strips(int min_cells) const {
  return max_strips(cells[0], min_cells);
}

double CutRoom::num_cells() const {
  return static_cast<double>(cells[0]) * static_cast<double>(cells[1]) *
         static_cast<double>(cells[2]);
}

template <int Dim>
CutRoom room_of(const Grid<Dim>& grid, std::int64_t num_particles) {
  CutRoom room;
  room.dimension = Dim;
  room.num_particles = num_particles;
  for (int axis = 0; axis < Dim; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    room.cells[k] = grid.cells(axis);
    room.axes[k] = grid.axis(axis);
    room.is_periodic[k] = grid.is_periodic(axis);
  }
  return room;
}

/// Particles lie as densely wherever they are, and cuts on faces of cells.
double predicted_step(const CutShape& shape, const CutRoom& room) {
  double per_cell = static_cast<double>(room.num_particles);
  for (std::size_t k = 0; k < 3; ++k) per_cell /= room.num_filled(k);
  double own = 1.0, with_ghosts = 1.0, beside = 1.0, beside_in_rank = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int along = shape.along(static_cast<int>(k));
    const int thick = (room.num_filled(k) + along - 1) / along;
    const int cuts = along == 1 ? 0 : (along == 2 && !room.is_periodic[k] ? 1 : 2);
    own *= thick;
    with_ghosts *= thick + cuts;
    beside *= 1 + std::min(along - 1, 2);
    beside_in_rank *= 1 + std::min(shape.lanes[k] - 1, 2);
  }
  const double remote = shape.num_ranks() == 1 ? 0.0 : std::max(0.0, beside - beside_in_rank);
  return per_cell * (own + kGhost * (with_ghosts - own)) + kMessage * remote +
         kHandOver * (beside - 1.0 - remote);
}

int most_depth(int ranks, const CutRoom& room) {
  int depth = 0;
  const auto fits_with = [&](int d) {
    const CutShape shape{CutForm::Strips, {ranks, 1, 1}, {1, 1, 1}, d};
    return ranks <= room.most_strips(min_cells(shape));
  };
  while (fits_with(depth + 1)) ++depth;
  return depth;
}

bool fits_somehow(int ranks, CutWish::Kind kind, const CutRoom& room) {
  if (ranks <= room.most_strips()) return true;
  return kind != CutWish::Kind::Strips && as_bricks(ranks, room).step < kDoesNotFit;
}

CutShape choose_cuts(const CutRequest& request, const CutRoom& room) {
  if (request.depth > 0 && request.ranks > 1) return with_shadows(request, room);
  if (request.wish.kind == CutWish::Kind::Bricks) return as_asked(request, room);
  const Choice strips = best_strips(request, room);
  if (request.wish.kind == CutWish::Kind::Strips || request.needs_strips) {
    if (strips.step < kDoesNotFit) return strips.shape;
    const int most = room.most_strips();
    refuse(request, room,
           fmt::format("{} ranks as strips of {} cells, of which {} fit{} into {} cells along {}",
                       request.ranks, kMinSlabs, most, most == 1 ? "s" : "", room.cells[0],
                       "xyz"[room.axes[0]]));
  }
  const Choice bricks = best_bricks(request, room, products(request.ranks, room.dimension));
  if (strips.step == kDoesNotFit && bricks.step == kDoesNotFit)
    refuse(request, room,
           fmt::format("{} ranks for a domain of {} cells", request.ranks,
                       describe({CutForm::Bricks, room.cells, {1, 1, 1}}, room)));
  return bricks.step < kClearlyBetter * strips.step ? bricks.shape : strips.shape;
}

std::array<int, 3> along_xyz(const std::array<int, 3>& shape, const CutRoom& room) {
  std::array<int, 3> xyz{1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) xyz[static_cast<std::size_t>(room.axes[k])] = shape[k];
  return xyz;
}

std::string describe(const CutShape& shape, const CutRoom& room) {
  if (shape.form == CutForm::Strips) return "strips";
  const auto xyz = along_xyz(shape.ranks, room);
  return room.dimension == 3 ? fmt::format("{} x {} x {}", xyz[0], xyz[1], xyz[2])
                             : fmt::format("{} x {}", xyz[0], xyz[1]);
}

CutWish parse_cuts(const std::string& text) {
  CutWish wish;
  if (text == "auto") return wish;
  wish.kind = text == "strips" ? CutWish::Kind::Strips : CutWish::Kind::Bricks;
  if (text == "strips") return wish;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t k = 0; k < 3 && at != end; ++k) {
    const auto [next, error] = std::from_chars(at, end, wish.bricks[k]);
    if (error != std::errc() || wish.bricks[k] < 1 || wish.bricks[k] > CutWish::kMost) break;
    at = next;
    if (at != end && (*at == ',' || *at == 'x')) ++at;
  }
  if (at == end && text.find_first_of(",x") != std::string::npos && text.back() >= '0' &&
      text.back() <= '9')
    return wish;
  throw InputError("cuts '" + text + "' are neither auto, strips nor numbers",
                   "give the bricks along x, y and z, as in --cuts 2,2,1");
}

template CutRoom room_of(const Grid<2>&, std::int64_t);
template CutRoom room_of(const Grid<3>&, std::int64_t);

}  // namespace barchan
