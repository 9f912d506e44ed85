// SPDX-License-Identifier: GPL-3.0-or-later
// Reading checks everything before it is used. A bad file is an error with its reason.
#include "core/constraint/problem_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "core/base/input_error.h"

namespace insula {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");
constexpr char magic[] = "INSULAP1";

class Reader {
 public:
  Reader(const std::vector<char>& bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  template <typename T>
  T next() {
    T value;
    if (bytes_.size() - at_ < sizeof value) throw InputError(name_ + ": ends too early");
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::vector<char>& bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

template <typename T>
void put(std::ofstream& out, T value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

constexpr double most = 1e12;  // largest number in a sound problem
bool usable(double x) { return std::abs(x) < most; }
bool bound(double x) { return usable(x) || std::isinf(x); }

std::string unsound_block(const ConstraintProblem& p, std::size_t k) {
  const Block& b = p.blocks[k];
  if (b.law != LawKind::box && b.law != LawKind::friction && b.law != LawKind::patch) return "unknown law";
  if (!(usable(b.compliance) && b.compliance >= 0)) return "compliance out of range";
  if (!(bound(b.lower) && bound(b.upper) && b.lower <= b.upper && b.lower < infinite && b.upper > -infinite))
    return "bounds out of order";
  if (!(usable(b.friction) && b.friction >= 0)) return "friction out of range";
  if (b.law != LawKind::patch) return b.normals == 0 ? "" : "normals of a block that is no patch";
  if (b.normals < 1 || std::size_t(b.normals) > k) return "a patch without its contacts";
  for (std::size_t i = k - std::size_t(b.normals); i < k; ++i)
    if (p.blocks[i].law != LawKind::box) return "a patch whose contacts have more than one row";
  return "";
}

}  // namespace

std::string unsound(const ConstraintProblem& p) {
  if (p.rows < 0 || p.rows > max_file_rows || p.stride < p.rows ||
      p.w.size() < std::size_t(p.rows) * std::size_t(p.stride))
    return "sizes do not fit";
  if (p.delta_free.size() != std::size_t(p.rows) || p.lambda.size() != std::size_t(p.rows)) return "sizes do not fit";
  int row = 0;
  for (std::size_t k = 0; k < p.blocks.size(); ++k) {
    if (const std::string why = unsound_block(p, k); !why.empty()) return fmt::format("block {}: {}", k, why);
    if (p.blocks[k].row != row) return fmt::format("block {}: does not follow the one before it", k);
    row += p.blocks[k].rows();
  }
  if (row != p.rows) return "the blocks do not cover the rows";
  for (int i = 0; i < p.rows; ++i) {
    if (!usable(p.delta_free[std::size_t(i)])) return fmt::format("delta_free of row {} is no usable number", i);
    if (!usable(p.lambda[std::size_t(i)])) return fmt::format("lambda of row {} is no usable number", i);
    if (!(p.w_at(i, i) >= 0)) return fmt::format("W has a negative diagonal in row {}", i);
    for (int j = 0; j <= i; ++j)
      if (!usable(p.w_at(i, j)) || p.w_at(i, j) != p.w_at(j, i))
        return fmt::format("W in row {}, column {} is no usable number or not symmetric", i, j);
  }
  return "";
}

void write_problem(const std::filesystem::path& file, const ConstraintProblem& p) {
  std::ofstream out(file, std::ios::binary);
  out.write(magic, 8);
  put(out, std::int32_t(p.rows));
  put(out, std::int32_t(p.blocks.size()));
  for (const Block& b : p.blocks) {
    put(out, b.id);
    put(out, std::int32_t(b.law));
    put(out, std::int32_t(b.normals));
    for (const double x : {b.compliance, b.lower, b.upper, b.friction}) put(out, x);
  }
  for (int i = 0; i < p.rows; ++i) put(out, p.delta_free[std::size_t(i)]);
  for (int i = 0; i < p.rows; ++i) put(out, p.lambda[std::size_t(i)]);
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j <= i; ++j) put(out, p.w_at(i, j));
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written");
}

ConstraintProblem read_problem(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(name + ": cannot be read");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  if (bytes.size() < 8 || std::memcmp(bytes.data(), magic, 8) != 0)
    throw InputError(name + ": is no constraint problem");
  Reader read(bytes, name);
  read.next<std::uint64_t>();
  const auto rows = read.next<std::int32_t>(), blocks = read.next<std::int32_t>();
  if (rows < 0 || rows > max_file_rows)
    throw InputError(fmt::format("{}: {} rows, 0 to {} are possible", name, rows, max_file_rows));
  if (blocks < 0 || blocks > rows) throw InputError(fmt::format("{}: {} blocks for {} rows", name, blocks, rows));
  const std::size_t n = std::size_t(rows), expected = std::size_t(blocks) * 48 + 8 * (2 * n + n * (n + 1) / 2);
  if (read.left() != expected)
    throw InputError(fmt::format("{}: has {} bytes after its head, {} are expected", name, read.left(), expected));
  ConstraintProblem p;
  p.resize(rows);
  int row = 0;
  for (int k = 0; k < blocks; ++k) {
    Block b;
    b.id = read.next<std::uint64_t>();
    const auto law = read.next<std::int32_t>();
    if (law < 0 || law > 2) throw InputError(fmt::format("{}: block {}: unknown law", name, k));
    b.law = LawKind(law);
    b.normals = read.next<std::int32_t>();
    for (double* x : {&b.compliance, &b.lower, &b.upper, &b.friction}) *x = read.next<double>();
    b.row = row;
    row += b.rows();
    p.blocks.push_back(b);
  }
  for (double& x : p.delta_free) x = read.next<double>();
  for (double& x : p.lambda) x = read.next<double>();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      p.w[i * std::size_t(p.stride) + j] = p.w[j * std::size_t(p.stride) + i] = read.next<double>();
  if (const std::string why = unsound(p); !why.empty()) throw InputError(name + ": " + why);
  return p;
}

std::vector<std::filesystem::path> problem_files(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  if (error) throw InputError(folder.string() + ": " + error.message());
  std::vector<std::filesystem::path> out;
  for (const auto& entry : entries)
    if (entry.path().extension() == ".problem") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace insula
