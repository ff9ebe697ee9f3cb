// TUN devices of the lab and the few header fields that it reads.
#pragma once

#include <fcntl.h>
#include <linux/ethtool.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

namespace netlab {

[[noreturn]] inline void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

/// Tells programs that choose protocols by link speed what the lab's rate is. Best effort: a kernel
/// that refuses leaves the device at its nominal 10 Mbit/s.
inline void announce_speed(const std::string& device, double bits_per_second) {
  alignas(ethtool_link_settings) std::array<std::byte, sizeof(ethtool_link_settings) + 4 * 3 * 127>
      memory{};
  auto& request =
      *new (memory.data()) ethtool_link_settings{};  // ends in masks of a length the kernel tells
  ifreq ifr{};
  std::strncpy(ifr.ifr_name, device.c_str(), IFNAMSIZ - 1);
  ifr.ifr_data = reinterpret_cast<char*>(memory.data());
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  request.cmd = ETHTOOL_GLINKSETTINGS;  // the first call answers how long the masks are, negated
  if (ioctl(fd, SIOCETHTOOL, &ifr) == 0 && request.link_mode_masks_nwords < 0) {
    request.link_mode_masks_nwords = static_cast<std::int8_t>(-request.link_mode_masks_nwords);
    request.cmd = ETHTOOL_SLINKSETTINGS;
    request.speed = static_cast<std::uint32_t>(std::max(1.0, bits_per_second / 1e6));
    request.duplex = DUPLEX_FULL;
    ioctl(fd, SIOCETHTOOL, &ifr);
  }
  close(fd);
}

/// A device whose reads and writes are a virtio header and an IPv4 packet, never blocking.
/// With offload, a TCP burst of up to 64 KiB is one packet and nobody computes checksums.
inline int open_tun(const std::string& device, bool offload) {
  const int fd = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) fail("open /dev/net/tun");
  ifreq ifr{};
  std::strncpy(ifr.ifr_name, device.c_str(), IFNAMSIZ - 1);
  ifr.ifr_flags = IFF_TUN | IFF_NO_PI | IFF_VNET_HDR;
  if (ioctl(fd, TUNSETIFF, &ifr) < 0) fail("TUNSETIFF " + device);
  if (offload && ioctl(fd, TUNSETOFFLOAD, TUN_F_CSUM | TUN_F_TSO4) < 0)
    fail("TUNSETOFFLOAD " + device);
  return fd;
}

/// What a TUN device puts before each packet: `struct virtio_net_hdr` of <linux/virtio_net.h>,
/// which is not C++.
struct OffloadHeader {
  std::uint8_t flags, gso_type;
  std::uint16_t header_bytes_hint, gso_size, checksum_start, checksum_offset;
};

/// One frame as a TUN device gives it: | OffloadHeader | IPv4 header | ... |
class Frame {
 public:
  Frame(const char* data, std::size_t size) : x_data(data), x_size(size) {
    if (size >= header_size) std::memcpy(&x_header, data, header_size);
  }

  std::size_t ip_bytes() const { return x_size - header_size; }

  /// Index of the host that it is for, 0 to hosts − 1, by its address 10.77.0.(1 + index); −1 for
  /// anything else.
  int receiver(int hosts) const {
    if (x_size < header_size + 20 || ip(0) >> 4 != 4) return -1;
    const int host = ip(19) - 1;
    const bool is_ours = ip(16) == 10 && ip(17) == 77 && ip(18) == 0 && host >= 0 && host < hosts;
    return is_ours ? host : -1;
  }

  /// Addresses, protocol and ports in one number. @pre receiver() was not −1
  std::uint64_t flow() const {
    const std::size_t ports = 4u * (ip(0) & 15u);
    const bool has_ports = (ip(9) == 6 || ip(9) == 17) && ip_bytes() >= ports + 4;
    std::uint32_t pair = 0;
    if (has_ports) std::memcpy(&pair, x_data + header_size + ports, 4);
    return std::uint64_t{pair} | std::uint64_t{ip(15)} << 32 | std::uint64_t{ip(19)} << 40 |
           std::uint64_t{ip(9)} << 48;
  }

  /// IP bytes on the wire: a TCP burst under offload has its headers once per segment. @pre as
  /// flow()
  double wire_bytes() const {
    const std::size_t tcp = 4u * (ip(0) & 15u);
    if (x_header.gso_type == 0 || x_header.gso_size == 0 || ip_bytes() < tcp + 20)
      return double(ip_bytes());
    const std::size_t headers = std::min<std::size_t>(ip_bytes(), tcp + 4u * (ip(tcp + 12) >> 4));
    const std::size_t payload = ip_bytes() - headers;
    const std::size_t segments = (payload + x_header.gso_size - 1) / x_header.gso_size;
    return double(payload + std::max<std::size_t>(segments, 1) * headers);
  }

  /// A TCP packet that carries nothing but an acknowledgement. @pre as flow()
  bool is_bare() const {
    const std::size_t tcp = 4u * (ip(0) & 15u);
    if (ip(9) != 6 || ip_bytes() < tcp + 20) return false;
    const std::size_t total = ip(2) << 8 | ip(3);
    return total <= tcp + 4u * (ip(tcp + 12) >> 4);
  }

  static constexpr std::size_t header_size = sizeof(OffloadHeader);

 private:
  unsigned ip(std::size_t at) const { return static_cast<unsigned char>(x_data[header_size + at]); }

  const char* x_data;
  std::size_t x_size;
  OffloadHeader x_header{};
};

}  // namespace netlab
