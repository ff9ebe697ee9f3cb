#pragma once

namespace barchan {

/// Memory of this node that programs may still take [bytes]; infinity where the system does not
/// tell.
[[nodiscard]] double memory_left();

}  // namespace barchan
