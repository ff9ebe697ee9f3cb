#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
/// Each link belongs to one of the two; all that is collective is done by both. Where no link of
/// one kind exists anywhere, that exchange is not made.
class MixedExchange final : public Exchange {
 public:
  using Make = std::unique_ptr<Exchange> (*)(std::string_view, const Communicator&,
                                             const Neighbours&, const ExchangeOptions&);
  /// Collective. Errors, the same on every rank: those of `make`.
  MixedExchange(const ExchangeMix& mix, const Communicator& communicator,
                const Neighbours& neighbours, const ExchangeOptions& options, Make make);

  std::string_view name() const override { return name_; }
  void reserve(std::size_t bytes) override;
  std::span<std::byte> outgoing(int link, std::size_t bytes) override {
    return of(link).outgoing(link, bytes);
  }
  void send(int link) override { of(link).send(link); }
  bool poll(int link) override { return of(link).poll(link); }
  std::span<const std::byte> received(int link) const override { return of(link).received(link); }
  void release(int link) override { of(link).release(link); }
  void begin_bulk(std::span<const std::span<const std::byte>> outgoing) override;
  void progress() override;
  bool needs_progress() const override;
  bool poll_bulk() override;
  std::vector<std::byte>& bulk(int link) override { return of(link).bulk(link); }
  std::int64_t bulk_posted(int link) const override { return of(link).bulk_posted(link); }
  ExchangeStats stats() const override;
  HaloTimes halo_times(int link) const override { return of(link).halo_times(link); }
  bool is_blocking() const override;
  bool allows_uneven_sides() const override;

 private:
  [[nodiscard]] Exchange& of(int link) const { return *of_link_[static_cast<std::size_t>(link)]; }

  std::string name_;
  std::array<std::unique_ptr<Exchange>, 2> parts_;  ///< near, far; one may be null
  std::vector<Exchange*> of_link_;                  ///< one without neighbour has any of them
};

}  // namespace barchan
