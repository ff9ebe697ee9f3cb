#include <barchan/tasks/checkpoint_load.hpp>

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/base/exact_sum.hpp>
#include <barchan/core/laws/laws.hpp>
#include <barchan/core/links/bonds.hpp>
#include <barchan/core/links/wall_shape.hpp>
#include <barchan/core/particles/fields.hpp>
#include <barchan/core/particles/layout.hpp>
#include <barchan/core/simd/scalar.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/checkpoint_read.hpp>
#include <barchan/tasks/cuts.hpp>

namespace barchan {
namespace {

ShareLimits limits_of(const Model& model, const CheckpointState& state) {
  return {model.dimension,    model.materials.size(), model.walls.size(), model.bond_laws.size(),
          model.contacts.law, model.heat.is_on,       num_carried(state)};
}

template <class T>
void take(const std::vector<T>& from, std::size_t number, std::size_t width, std::vector<T>& to) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(number * width);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
}

template <int Dim>
void take_particle(const CheckpointShare& from, std::size_t p, int num_carried,
                   CheckpointShare& to) {
  for_each_field<Dim>([&](const auto& field) {
    const auto& values = from.*field.saved;
    if (!values.empty()) take(values, p, static_cast<std::size_t>(field.width), to.*field.saved);
  });
  take(from.carried, p, static_cast<std::size_t>(num_carried), to.carried);
}

using Ids = std::unordered_set<std::int64_t>;

template <int Dim>
void take_links(const CheckpointShare& from, const Ids& mine, std::size_t history_length,
                CheckpointShare& to) {
  const auto has_end = [&mine](const std::vector<std::int64_t>& ids, std::size_t k) {
    return mine.contains(ids[2 * k]) || mine.contains(ids[2 * k + 1]);
  };
  for (std::size_t k = 0; k < from.contact_ids.size() / 2; ++k) {
    if (!has_end(from.contact_ids, k)) continue;
    take(from.contact_ids, k, 2, to.contact_ids);
    take(from.contact_springs, k, history_length, to.contact_springs);
  }
  for (std::size_t k = 0; k < from.wall_contact_ids.size(); ++k) {
    if (!mine.contains(from.wall_contact_ids[k])) continue;
    take(from.wall_contact_ids, k, 1, to.wall_contact_ids);
    take(from.wall_contact_walls, k, 1, to.wall_contact_walls);
    take(from.wall_contact_images, k, WallImage().size(), to.wall_contact_images);
    take(from.wall_contact_springs, k, history_length, to.wall_contact_springs);
  }
  for (std::size_t k = 0; k < from.bond_laws.size(); ++k) {
    if (!has_end(from.bond_ids, k)) continue;
    take(from.bond_ids, k, 2, to.bond_ids);
    take(from.bond_laws, k, 1, to.bond_laws);
    take(from.bond_lengths, k, 1, to.bond_lengths);
    take(from.bond_states, k, Bond<Dim>::kState, to.bond_states);
  }
}

/// Loads the shares of one rank. Files name where along the grid's first axis their particles lie;
/// links reach as far as a slab is wide.
template <int Dim>
class Loader {
 public:
  Loader(const Communicator& communicator, const OpenCheckpoint& checkpoint, const Model& model,
         const Grid<Dim>& grid)
      : communicator_(communicator),
        checkpoint_(checkpoint),
        limits_(limits_of(model, checkpoint.state)),
        grid_(grid),
        loads_(room_of(grid, 0).cells) {}

  /// Particles by coordinates of cells, and the totals. Collective.
  void count() {
    std::vector<std::int64_t> sums(loads_.all().size() + num_totals(limits_.num_walls), 0);
    agree(communicator_, [&] {
      const auto stride = static_cast<std::size_t>(communicator_.size());
      for (auto r = static_cast<std::size_t>(communicator_.rank()); r < num_files(); r += stride)
        count_file(r, sums);
    });
    std::ranges::copy(loads_.all(), sums.begin());
    communicator_.allreduce_sum(std::span<std::int64_t>(sums));
    communicator_.allreduce_max(std::span(&outrun_, 1));
    const auto totals = sums.begin() + static_cast<std::ptrdiff_t>(loads_.all().size());
    std::copy(sums.begin(), totals, loads_.all().begin());
    totals_.assign(totals, sums.end());
  }

  LoadedShares load(const LaneMap& lanes) {
    LoadedShares loaded{equal_cuts(loads_, lanes.shape()), {}, totals_};
    const int num_lanes = lanes.shape().num_lanes();
    loaded.shares.resize(static_cast<std::size_t>(num_lanes));
    begin_ = grid_.num_slabs();
    for (int l = 0; l < num_lanes; ++l) {
      boxes_.push_back(placement<Dim>(lanes, loaded.cuts, communicator_.rank(), l, {}).box);
      begin_ = std::min(begin_, boxes_.back().lo[0]);
      end_ = std::max(end_, boxes_.back().hi[0]);
    }
    agree(communicator_, [&] {
      for_each_file(0, [&](const CheckpointShare& share) { take_particles(share, loaded.shares); });
      std::vector<Ids> ids;
      for (const CheckpointShare& share : loaded.shares)
        ids.emplace_back(share.ids.begin(), share.ids.end());
      const auto history_length = static_cast<std::size_t>(history_in<Dim>(limits_.law).length);
      for_each_file(1, [&](const CheckpointShare& share) {
        for (std::size_t l = 0; l < ids.size(); ++l)
          take_links<Dim>(share, ids[l], history_length, loaded.shares[l]);
      });
      for (CheckpointShare& share : loaded.shares) {
        share.totals = totals_;
        share.outruns = {outrun_};
        check_share(share, limits_, checkpoint_.path);
      }
    });
    return loaded;
  }

 private:
  [[nodiscard]] std::size_t num_files() const { return checkpoint_.manifest.files.size(); }
  [[nodiscard]] CheckpointShare read(std::size_t r) const {
    return RankFile(checkpoint_.path, checkpoint_.manifest, r).view().share(limits_);
  }
  [[nodiscard]] CellAt<Dim> cell(const CheckpointShare& share, std::size_t p) const {
    return grid_.cell(share.positions.data() + p * Dim);
  }

  /// @param sums  the totals of this rank's files, behind room for counts
  void count_file(std::size_t r, std::vector<std::int64_t>& sums) {
    const CheckpointShare share = read(r);
    const ManifestFile& listed = checkpoint_.manifest.files[r];
    for (std::size_t p = 0; p < share.ids.size(); ++p) {
      const double at = grid_.along_strips(share.positions.data() + p * Dim);
      if (!(at >= listed.lo && at <= listed.hi)) refuse(r, "has particles outside its strip");
      loads_.add<Dim>(cell(share, p));
    }
    for (const double distance2 : share.outruns) outrun_ = std::max(outrun_, distance2);
    for (std::size_t t = 0; t < share.totals.size(); ++t)
      sums[loads_.all().size() + t] += share.totals[t];
    const bool is_whole =
        static_cast<std::int64_t>(share.ids.size()) == listed.particles &&
        static_cast<std::int64_t>(share.contact_ids.size() / 2) == listed.contacts &&
        static_cast<std::int64_t>(share.wall_contact_ids.size()) == listed.wall_contacts &&
        static_cast<std::int64_t>(share.bond_laws.size()) == listed.bonds;
    if (!is_whole)
      refuse(r, "does not hold as many particles, contacts and bonds as the manifest lists");
  }

  [[noreturn]] void refuse(std::size_t r, const std::string& what) const {
    throw InputError(SourcePlace{checkpoint_.file(r), 0, 0}, what, "take another checkpoint");
  }

  template <class Visit>
  void for_each_file(int reach, Visit&& visit) const {
    for (std::size_t r = 0; r < num_files(); ++r) {
      if (concerns(checkpoint_.manifest.files[r], reach)) visit(read(r));
    }
  }

  /// Whether a file has particles within `reach` slabs of this rank's, around the end too. A slab
  /// more, for what lies outside the domain counts to the last slab, and for rounding.
  [[nodiscard]] bool concerns(const ManifestFile& file, int reach) const {
    if (file.particles == 0) return false;
    const int n = grid_.num_slabs(), first = grid_.slab_at(file.lo), last = grid_.slab_at(file.hi);
    for (const int shift : {0, n, -n}) {
      if (first + shift <= end_ + reach && last + shift >= begin_ - reach - 1) return true;
    }
    return false;
  }

  void take_particles(const CheckpointShare& from, std::vector<CheckpointShare>& shares) const {
    for (std::size_t p = 0; p < from.ids.size(); ++p) {
      const CellAt<Dim> at = cell(from, p);
      for (std::size_t l = 0; l < boxes_.size(); ++l) {
        if (boxes_[l].contains(at)) take_particle<Dim>(from, p, limits_.num_carried, shares[l]);
      }
    }
  }

  const Communicator& communicator_;
  const OpenCheckpoint& checkpoint_;
  ShareLimits limits_;
  const Grid<Dim>& grid_;
  CellLoads loads_;
  std::vector<std::int64_t> totals_;
  double outrun_ = 0.0;
  std::vector<CellBox<Dim>> boxes_;  ///< of this rank's lanes
  int begin_ = 0, end_ = 0;          ///< slabs of this rank
};

void check_same_sources(const OpenCheckpoint& checkpoint, const Model& model) {
  const std::string what = source_differences(checkpoint.manifest.sources, model.sources);
  if (what.empty()) return;
  throw InputError(SourcePlace{checkpoint.path, 0, 0},
                   "the checkpoint is of a run with other particles: " + what,
                   "restart with the [[particles]] of that run; or leave --restart out and give "
                   "--out another folder, to begin a run with these");
}

}  // namespace

OpenCheckpoint open_checkpoint(const Communicator& communicator, const std::string& path,
                               const Model& model) {
  OpenCheckpoint checkpoint{path, read_shared_manifest(communicator, path), {}};
  agree(communicator, [&] {
    const std::string file = checkpoint.file(0);
    if (checkpoint.manifest.dimension != model.dimension) {
      throw InputError(
          SourcePlace{path, 0, 0},
          fmt::format("the checkpoint is of a run in {} dimensions", checkpoint.manifest.dimension),
          "restart with the deck of that run");
    }
    const RankFile first(path, checkpoint.manifest, 0);
    checkpoint.state = decode_state(first.view().state(), file);
    check_same_model(checkpoint.state, model, file);
    check_same_sources(checkpoint, model);
    const bool is_whole = checkpoint.state.step == checkpoint.manifest.step &&
                          checkpoint.state.num_particles == checkpoint.manifest.totals().particles;
    if (!is_whole)
      throw InputError(SourcePlace{path, 0, 0}, "the manifest and the state contradict each other",
                       "take another checkpoint");
  });
  return checkpoint;
}

template <int Dim>
LoadedShares load_shares(const Communicator& communicator, const OpenCheckpoint& checkpoint,
                         const Model& model, const Grid<Dim>& grid, const LaneMap& lanes) {
  Loader<Dim> loader(communicator, checkpoint, model, grid);
  loader.count();
  return loader.load(lanes);
}

template LoadedShares load_shares<2>(const Communicator&, const OpenCheckpoint&, const Model&,
                                     const Grid<2>&, const LaneMap&);
template LoadedShares load_shares<3>(const Communicator&, const OpenCheckpoint&, const Model&,
                                     const Grid<3>&, const LaneMap&);

}  // namespace barchan
