#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <barchan/core/model/model.hpp>

namespace barchan {

/// A byte counts their pairs.
inline constexpr std::size_t kMostMaterials = 22;

/// What is wrong with a model, and where: `time.step`, `wall.2.normal` (entries count from 1, as in
/// `--set`).
struct ModelFault {
  std::string key, what, remedy;
};

/// Whether the law at a place of the list, with twisting, is for so many dimensions. Pure.
[[nodiscard]] std::optional<ModelFault> find_law_fault(int law, bool twisting, int dimension);

/// The first thing that no run could work with, whoever made the model: sizes that do not fit
/// together, numbers that are not finite or of the wrong sign, a third component in 2D, indices
/// beyond their table, walls without a unit normal, stages that never begin. Pure.
[[nodiscard]] std::optional<ModelFault> find_fault(const Model& model);

/// Errors: InputError for what find_fault finds.
void validate(const Model& model);

/// Errors: InputError for intervals below zero, or fewer than one checkpoint to keep.
void validate(const CheckpointSpec& spec);

}  // namespace barchan
