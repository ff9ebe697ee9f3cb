#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <barchan/core/brick/brick.hpp>
#include <barchan/core/brick/lists.hpp>
#include <barchan/core/kernels/pair_job.hpp>

namespace barchan {

/// The steady step of a brick (tasks/step_tasks.hpp says what precedes what):
///
///   press_plates · begin · run_chunk(0) · run_chunk(1) … · finish_band(side), its ghosts there
///
/// Forces of pairs are rounded to the grain, so that sums have no order (force_grain.hpp). Rows
/// away from the cuts are advanced in place, chunk by chunk; those of a band when the pairs with
/// its ghosts are in.
template <int Dim>
class Step {
 public:
  Step(Brick<Dim>& brick, Lists<Dim>& lists) : brick_(brick), lists_(lists) {}

  /// Contacts with loaded plates, before the step's other forces: their forces on the plates are
  /// added to `sums`, one a wall. Needs owned rows only.
  void press_plates(const StepFrame& frame, std::span<WallSums> sums);
  void begin(const StepFrame& frame);
  void run_chunk(int chunk);
  /// @pre all chunks that feed its rows (step_tasks.hpp), and its ghosts
  void finish_band(Side side);
  /// The published scheme: instead of finish_band(Right). @param results  see add_results
  void finish_right_band(std::span<const double> results);

 private:
  /// What contacts lose is of use.
  [[nodiscard]] bool counts_losses() const {
    return brick_.world->accounts || brick_.world->heat.dissipates;
  }
  [[nodiscard]] typename WallContacts<Dim>::Frame wall_frame(const StepFrame& frame) {
    return {brick_.world->wall_view(), &brick_.world->laws, frame.last_dt, frame.kick,
            counts_losses() ? &wall_losses_ : nullptr};
  }
  /// The pairs of a block that are worked on.
  [[nodiscard]] PairJob job(PairList& list, PairBlock& block, double travel);
  void run_block(RowBlock& block);
  void finish_rows(Rows rows, bool has_extras);
  void advance_rows(Rows rows, bool has_extras);
  void add_extras(Rows rows);
  void wrap_rows(Rows rows);
  void compute_bonds(typename BondSet<Dim>::Group group);
  void unbind(std::int32_t bond);

  Brick<Dim>& brick_;
  Lists<Dim>& lists_;
  StepFrame frame_;
  bool wraps_ = false;          ///< after this step
  bool looks_ = false;          ///< for passages, in this step
  std::int32_t rows_done_ = 0;  ///< of those away from bands
  std::int64_t num_steps_ = 0;
  WorkAccount<Dim> account_;
  std::vector<WallLoss> wall_losses_;  ///< of the rows that are being finished
};

/// After rows have come and gone, and lists have another skin: what is quick.
template <int Dim>
void find_quick(Brick<Dim>& brick);

extern template class Step<2>;
extern template class Step<3>;

}  // namespace barchan
