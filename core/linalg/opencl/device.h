// SPDX-License-Identifier: GPL-3.0-or-later
// One OpenCL device with a queue of its own, its memory and the solver's kernels. Every function throws DeviceFailure.
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/linalg/opencl/api.h"

namespace insula::opencl {

constexpr int tile = 32;         ///< edge of the dense blocks that one group computes
constexpr int chunk = 16;        ///< columns that a group reads at once
constexpr int group = 64;        ///< items of a group; each computes 4 x 4 numbers of a tile
constexpr int line_group = 256;  ///< items of a group that works on one right-hand side

struct FoundDevice {
  cl_device_id id = nullptr;
  cl_device_type type = 0;
  std::string name;  ///< with platform and driver
};
/// Devices with double precision and a compiler: GPUs first, accelerators, then processors. INSULA_OPENCL_DEVICE in the
/// environment restricts them to those whose name contains that text. Empty without OpenCL.
std::vector<FoundDevice> find_devices();

class Buffer {
 public:
  Buffer() = default;
  Buffer(cl_context context, std::size_t bytes);
  ~Buffer();
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  const cl_mem& memory() const { return memory_; }
  std::size_t bytes() const { return bytes_; }

 private:
  cl_mem memory_ = nullptr;
  std::size_t bytes_ = 0;
};

enum class Kernel {
  scatter,
  assemble,
  update_block,
  factor_diagonal,
  solve_block,
  subtract_update,
  forward_one,
  backward_one,
  forward_own,
  forward_below,
  multiply_rows,
  multiply_load,
  add_parts,
  combine,
  count
};

class Device {
 public:
  /// Compiles the kernels, which takes a second or more when the driver has not kept them.
  explicit Device(const FoundDevice& found);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const std::string& name() const { return name_; }
  /// Enlarges `buffer` to at least `count` numbers of type T, without its content.
  template <class T>
  void reserve(Buffer& buffer, std::size_t count) {
    if (buffer.bytes() < count * sizeof(T) || buffer.bytes() == 0) buffer = make(count * sizeof(T));
  }
  template <class T>
  void upload(const Buffer& to, const T* from, std::size_t count) {
    write(to, from, count * sizeof(T));
  }
  template <class T>
  void upload_all(Buffer& to, const std::vector<T>& from) {
    reserve<T>(to, from.size());
    upload(to, from.data(), from.size());
  }
  /// Waits for everything before it.
  template <class T>
  void download(const Buffer& from, T* to, std::size_t count) {
    read(from, to, count * sizeof(T));
  }
  void copy(const Buffer& from, const Buffer& to, std::size_t bytes);
  void fill_zero(const Buffer& to, std::size_t bytes);
  void flush();

  /// Queues a kernel of `groups` groups of `items` items.
  template <class... Arguments>
  void run(Kernel kernel, std::size_t groups, int items, const Arguments&... arguments) {
    if (groups == 0) return;
    cl_uint number = 0;
    (set_argument(kernel, number++, arguments), ...);
    enqueue(kernel, groups, items);
  }
  /// Every call after so many more fails, for tests. Negative: none.
  void fail_after(int calls) { calls_left_ = calls; }
  int buffers_made() const { return buffers_made_; }

 private:
  Buffer make(std::size_t bytes);
  void write(const Buffer& to, const void* from, std::size_t bytes);
  void read(const Buffer& from, void* to, std::size_t bytes);
  void set_argument(Kernel kernel, cl_uint number, const Buffer& buffer);
  void set_argument(Kernel kernel, cl_uint number, int value);
  void set_argument(Kernel kernel, cl_uint number, double value);
  void enqueue(Kernel kernel, std::size_t groups, int items);
  void build(cl_device_id id);
  void release();
  void count_call();

  std::string name_;
  cl_context context_ = nullptr;
  cl_command_queue queue_ = nullptr;
  cl_program program_ = nullptr;
  std::vector<cl_kernel> kernels_;
  int calls_left_ = -1, buffers_made_ = 0;
};

}  // namespace insula::opencl
