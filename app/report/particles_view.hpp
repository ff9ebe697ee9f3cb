#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <barchan/app/loaded_deck.hpp>
#include <barchan/app/report/page.hpp>

// Particles over time for a page, as JSON:
//
//     dimension, lo, hi     the box of all positions, whose parts positions are: 0 to 65535
//     box                   {lo, hi} to draw: the domain, or that of the positions
//     radius, speed, spin   the largest ones; values are parts of them, 0 to 65535
//     materials, ranks      names, by number from 0
//     note                  what was left out
//     frames                step, time, n; in base64 position, speed, spin (16 bit), rank (8 bit),
//                           bonds (float x y z of both ends); radius (16 bit) and type (8 bit)
//                           where they differ from those before

namespace barchan::app {

struct ViewOptions {
  int most_frames = 40;
  std::size_t most_bytes = 24U << 20;  ///< of all frames, before base64
};

/// Of the snapshots in a run's folder, evenly over time; no frames where there are none.
/// @param deck  deck_keys of run.json, or null
[[nodiscard]] PageData snapshots_view(const std::string& folder, const PageData& deck,
                                      const ViewOptions& options);

/// Of what a deck makes.
[[nodiscard]] PageData deck_view(const LoadedDeck& loaded);

}  // namespace barchan::app
