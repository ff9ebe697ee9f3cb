#pragma once

#include <vector>

#include <barchan/core/deck/node.hpp>
#include <barchan/core/model/source_record.hpp>

namespace barchan::deck {

/// Every value in a table under its path, such as `region.lo` or `particle.2.radius`, in words that
/// do not depend on how the deck writes a number. Of more than a hundred values the further ones
/// become a hash under one key.
[[nodiscard]] std::vector<SourceKey> canonical_keys(const Node& table);

}  // namespace barchan::deck
