#include <barchan/core/checkpoint/manifest.hpp>

#include <xxhash.h>

#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

using nlohmann::ordered_json;

constexpr int kVersion = 5;
constexpr const char* kFormat = "barchan checkpoint";
constexpr std::string_view kHashMember = ",\n\"xxh3\": \"";
constexpr std::string_view kEnd = "\"}\n";

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw InputError(SourcePlace{file, 0, 0}, what, "take another checkpoint");
}

std::string hex(std::uint64_t value) {
  return fmt::format("{:016x}", value);
}

std::uint64_t hash_of(std::string_view text) {
  return XXH3_64bits(text.data(), text.size());
}

std::uint64_t parse_hex(const std::string& text) {
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size())
    throw std::invalid_argument("not a checksum");
  return value;
}

/// The JSON without its last member. @return what that was taken over, closed again
std::string verified_part(const std::string& text, const std::string& file) {
  const std::size_t length = kHashMember.size() + 16 + kEnd.size();
  if (text.size() < length) refuse(file, "too short for a manifest");
  const std::string_view all(text), body = all.substr(0, all.size() - length);
  const std::string expected = std::string(kHashMember) + hex(hash_of(body)) + std::string(kEnd);
  if (all.substr(body.size()) != expected) refuse(file, "damaged or cut off: its checksum differs");
  return std::string(body) + "}";
}

/// A whole number from zero to `most`. The library would convert a float of any size.
std::int64_t count(const ordered_json& value, const char* what,
                   std::int64_t most = std::int64_t{1} << 48) {  // sums over all files hold
  if (!value.is_number_integer()) throw std::invalid_argument(std::string(what) + " is no number");
  const auto number = value.get<std::int64_t>();
  if (number < 0 || number > most)
    throw std::invalid_argument(std::string(what) + " is out of range");
  return number;
}

std::int64_t count_at(const ordered_json& node, const char* key) {
  return count(node.at(key), key);
}

ManifestFile read_file(const ordered_json& node, std::size_t rank) {
  if (node.at("name").get<std::string>() != rank_file_name(rank))
    throw std::invalid_argument("files out of order");
  ManifestFile f;
  f.seal = {static_cast<std::uint64_t>(count_at(node, "bytes")),
            parse_hex(node.at("hash").get<std::string>())};
  f.lo = node.at("strip").at(0).get<double>();
  f.hi = node.at("strip").at(1).get<double>();
  f.particles = count_at(node, "particles");
  f.contacts = count_at(node, "contacts");
  f.wall_contacts = count_at(node, "wall_contacts");
  f.bonds = count_at(node, "bonds");
  return f;
}

SourceRecord read_source(const ordered_json& node) {
  SourceRecord source;
  source.kind = node.at("kind").get<std::string>();
  source.hash = parse_hex(node.at("hash").get<std::string>());
  for (const auto& [key, value] : node.at("keys").items())
    source.keys.push_back({key, value.get<std::string>()});
  return source;
}

Manifest read_manifest(const ordered_json& node, const std::string& path) {
  if (node.at("format").get<std::string>() != kFormat)
    throw std::invalid_argument("not a checkpoint's manifest");
  const std::int64_t version = count_at(node, "version");
  if (version != kVersion) {
    throw InputError(
        SourcePlace{path, 0, 0},
        fmt::format("a checkpoint of format version {}, and this program reads version {}", version,
                    kVersion),
        "go on with the version of barchan that wrote it, or start the run anew");
  }
  Manifest m;
  m.step = count_at(node, "step");
  m.time = node.at("time").get<double>();
  m.dimension = static_cast<int>(count(node.at("dimension"), "dimension", 3));
  m.title = node.at("title").get<std::string>();
  for (const auto& file : node.at("files")) m.files.push_back(read_file(file, m.files.size()));
  for (const auto& source : node.at("sources")) m.sources.push_back(read_source(source));
  if (m.files.empty() || (m.dimension != 2 && m.dimension != 3))
    throw std::invalid_argument("lists no files, or no dimension");
  return m;
}

}  // namespace

ManifestFile Manifest::totals() const {
  ManifestFile sum;
  for (const ManifestFile& f : files) {
    sum.seal.bytes += f.seal.bytes;
    sum.particles += f.particles;
    sum.contacts += f.contacts;
    sum.wall_contacts += f.wall_contacts;
    sum.bonds += f.bonds;
  }
  return sum;
}

std::string manifest_text(const Manifest& manifest) {
  const ManifestFile total = manifest.totals();
  ordered_json node{{"format", kFormat},
                    {"version", kVersion},
                    {"step", manifest.step},
                    {"time", manifest.time},
                    {"title", manifest.title},
                    {"dimension", manifest.dimension},
                    {"particles", total.particles},
                    {"contacts", total.contacts},
                    {"bonds", total.bonds},
                    {"bytes", total.seal.bytes}};
  auto& files = node["files"] = ordered_json::array();
  for (const ManifestFile& f : manifest.files) {
    files.push_back({{"name", rank_file_name(files.size())},
                     {"bytes", f.seal.bytes},
                     {"hash", hex(f.seal.hash)},
                     {"strip", {f.lo, f.hi}},
                     {"particles", f.particles},
                     {"contacts", f.contacts},
                     {"wall_contacts", f.wall_contacts},
                     {"bonds", f.bonds}});
  }
  auto& sources = node["sources"] = ordered_json::array();
  for (const SourceRecord& s : manifest.sources) {
    ordered_json keys = ordered_json::object();
    for (const SourceKey& k : s.keys) keys[k.key] = k.value;
    sources.push_back({{"kind", s.kind}, {"hash", hex(s.hash)}, {"keys", std::move(keys)}});
  }
  std::string text = node.dump(1, ' ', false, ordered_json::error_handler_t::replace);
  text.pop_back();  // the closing brace, which follows the checksum
  while (text.back() == '\n') text.pop_back();
  const std::string hash = hex(hash_of(text));
  return text + std::string(kHashMember) + hash + std::string(kEnd);
}

Manifest parse_manifest(const std::string& text, const std::string& file) {
  const std::string json = verified_part(text, file);
  try {
    return read_manifest(ordered_json::parse(json), file);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    refuse(file, std::string("is not valid: ") + e.what());
  }
}

std::string rank_file_name(std::size_t rank) {
  return fmt::format("rank_{:05}.bin", rank);
}

}  // namespace barchan
