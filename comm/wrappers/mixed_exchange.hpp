#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <barchan/comm/slots/exchange.hpp>

namespace barchan {

/// Two exchanges by name: "near+far".
struct ExchangeMix {
  std::string near, far;
  /// Nothing for a name without '+'.
  [[nodiscard]] static std::optional<ExchangeMix> parse(std::string_view name);
};

/// One exchange with the neighbours on this node, and another with those off it:
///
///     node         |      A      |      B      |
///     ranks        |  0   |   1  |   2  |   3  |
///     exchange       near    far    near            near lives among the ranks of a node only
///
/// Each side belongs to one of the two; all that is collective is done by both. Where no link of
/// one kind exists anywhere, that exchange is not made.
class MixedExchange final : public Exchange {
 public:
  using Make = std::unique_ptr<Exchange> (*)(std::string_view, const Communicator&, Neighbours,
                                             const ExchangeOptions&);
  /// Collective. Errors, the same on every rank: those of `make`.
  MixedExchange(const ExchangeMix& mix, const Communicator& communicator, Neighbours neighbours,
                const ExchangeOptions& options, Make make);

  std::string_view name() const override { return name_; }
  void reserve(std::size_t bytes) override;
  std::span<std::byte> outgoing(Side side, std::size_t bytes) override {
    return of(side).outgoing(side, bytes);
  }
  void send(Side side) override { of(side).send(side); }
  bool poll(Side side) override { return of(side).poll(side); }
  std::span<const std::byte> received(Side side) const override { return of(side).received(side); }
  void release(Side side) override { of(side).release(side); }
  void begin_bulk(std::span<const std::byte> to_left, std::span<const std::byte> to_right) override;
  void progress() override;
  bool needs_progress() const override;
  bool poll_bulk() override;
  std::vector<std::byte>& bulk(Side side) override { return of(side).bulk(side); }
  std::int64_t bulk_posted(Side side) const override { return of(side).bulk_posted(side); }
  ExchangeStats stats() const override;
  HaloTimes halo_times(Side side) const override { return of(side).halo_times(side); }
  bool is_blocking() const override;
  bool allows_uneven_sides() const override;

 private:
  [[nodiscard]] Exchange& of(Side side) const { return *of_side_[index_of(side)]; }

  std::string name_;
  std::array<std::unique_ptr<Exchange>, 2> parts_;  ///< near, far; one may be null
  std::array<Exchange*, 2> of_side_{};              ///< a side without neighbour has any of them
};

}  // namespace barchan
