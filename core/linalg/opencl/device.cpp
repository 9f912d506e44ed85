// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/opencl/device.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

#include "core/linalg/opencl/source.h"

namespace insula::opencl {
namespace {

constexpr std::array kernel_names{"scatter",     "assemble",        "update_block",  "factor_diagonal",
                                  "solve_block", "subtract_update", "forward_one",   "backward_one",
                                  "forward_own", "forward_below",   "multiply_rows", "multiply_load",
                                  "add_parts",   "combine"};
static_assert(kernel_names.size() == std::size_t(Kernel::count));

/// Zero when the device does not say it.
template <class T>
T number_of(cl_device_id id, cl_device_info what) {
  T value{};
  return api()->GetDeviceInfo(id, what, sizeof value, &value, nullptr) == CL_SUCCESS ? value : T{};
}

std::string text_of(cl_device_id id, cl_device_info what) {
  char text[512] = {};
  api()->GetDeviceInfo(id, what, sizeof text - 1, text, nullptr);
  return text;
}

std::string platform_name(cl_platform_id id) {
  char text[256] = {};
  api()->GetPlatformInfo(id, CL_PLATFORM_NAME, sizeof text - 1, text, nullptr);
  return text;
}

bool is_fit(cl_device_id id) {
  return number_of<cl_bool>(id, CL_DEVICE_AVAILABLE) && number_of<cl_bool>(id, CL_DEVICE_COMPILER_AVAILABLE) &&
         number_of<cl_bool>(id, CL_DEVICE_ENDIAN_LITTLE) &&
         number_of<cl_device_fp_config>(id, CL_DEVICE_DOUBLE_FP_CONFIG) != 0 &&
         number_of<std::size_t>(id, CL_DEVICE_MAX_WORK_GROUP_SIZE) >= std::size_t(line_group);
}

void add_devices(cl_platform_id platform, std::vector<FoundDevice>& out) {
  std::array<cl_device_id, 16> ids{};
  cl_uint count = 0;
  if (api()->GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, cl_uint(ids.size()), ids.data(), &count) != CL_SUCCESS) return;
  for (cl_uint i = 0; i < std::min(count, cl_uint(ids.size())); ++i) {
    if (!is_fit(ids[i])) continue;
    out.push_back({ids[i], number_of<cl_device_type>(ids[i], CL_DEVICE_TYPE),
                   text_of(ids[i], CL_DEVICE_NAME) + " (" + platform_name(platform) + ", driver " +
                       text_of(ids[i], CL_DRIVER_VERSION) + ")"});
  }
}

int rank(cl_device_type type) { return type & CL_DEVICE_TYPE_GPU ? 0 : type & CL_DEVICE_TYPE_ACCELERATOR ? 1 : 2; }

}  // namespace

std::vector<FoundDevice> find_devices() {
  std::vector<FoundDevice> out;
  std::array<cl_platform_id, 16> platforms{};
  cl_uint count = 0;
  if (!api() || api()->GetPlatformIDs(cl_uint(platforms.size()), platforms.data(), &count) != CL_SUCCESS) return out;
  for (cl_uint i = 0; i < std::min(count, cl_uint(platforms.size())); ++i) add_devices(platforms[i], out);
  if (const char* wanted = std::getenv("INSULA_OPENCL_DEVICE"))
    std::erase_if(out, [&](const FoundDevice& d) { return d.name.find(wanted) == std::string::npos; });
  std::stable_sort(out.begin(), out.end(),
                   [](const FoundDevice& a, const FoundDevice& b) { return rank(a.type) < rank(b.type); });
  return out;
}

Buffer::Buffer(cl_context context, std::size_t bytes) : bytes_(bytes) {
  cl_int status = CL_SUCCESS;
  memory_ = api()->CreateBuffer(context, CL_MEM_READ_WRITE, bytes, nullptr, &status);
  check(status, "clCreateBuffer");
}

Buffer::~Buffer() {
  if (memory_ != nullptr) api()->ReleaseMemObject(memory_);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(memory_, other.memory_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

namespace {

struct Compiled {
  cl_context context;
  cl_program program;
};

cl_program compile(cl_context context, const FoundDevice& device) {
  cl_int status = CL_SUCCESS;
  const char* text = kernel_source();
  const cl_program program = api()->CreateProgramWithSource(context, 1, &text, nullptr, &status);
  check(status, "clCreateProgramWithSource");
  const std::string options = "-cl-std=CL1.2 -D TILE=" + std::to_string(tile) + " -D CHUNK=" + std::to_string(chunk) +
                              " -D GROUP=" + std::to_string(group) + " -D LINE_GROUP=" + std::to_string(line_group);
  if (api()->BuildProgram(program, 1, &device.id, options.c_str(), nullptr, nullptr) == CL_SUCCESS) return program;
  std::string log(1 << 14, '\0');
  api()->GetProgramBuildInfo(program, device.id, CL_PROGRAM_BUILD_LOG, log.size() - 1, log.data(), nullptr);
  api()->ReleaseProgram(program);
  throw DeviceFailure("the kernels do not compile for " + device.name + ": " + log.substr(0, log.find('\0')));
}

/// All solvers of a device share its compiled kernels, which stay until the end of the process.
Compiled compiled_for(const FoundDevice& device) {
  static std::mutex mutex;
  static std::map<cl_device_id, Compiled> kept;
  const std::lock_guard lock(mutex);
  if (const auto found = kept.find(device.id); found != kept.end()) return found->second;
  cl_int status = CL_SUCCESS;
  const cl_context context = api()->CreateContext(nullptr, 1, &device.id, nullptr, nullptr, &status);
  check(status, "clCreateContext");
  try {
    return kept.emplace(device.id, Compiled{context, compile(context, device)}).first->second;
  } catch (...) {
    api()->ReleaseContext(context);
    throw;
  }
}

}  // namespace

Device::Device(const FoundDevice& found) : name_(found.name) {
  const Compiled compiled = compiled_for(found);
  context_ = compiled.context;
  program_ = compiled.program;
  try {
    build(found.id);
  } catch (...) {
    release();
    throw;
  }
}

/// A queue and kernels of its own: the arguments of a kernel belong to one thread.
void Device::build(cl_device_id id) {
  cl_int status = CL_SUCCESS;
  queue_ = api()->CreateCommandQueue(context_, id, 0, &status);
  check(status, "clCreateCommandQueue");
  for (const char* name : kernel_names) {
    kernels_.push_back(api()->CreateKernel(program_, name, &status));
    check(status, "clCreateKernel");
  }
}

void Device::release() {
  for (cl_kernel k : kernels_)
    if (k != nullptr) api()->ReleaseKernel(k);
  if (queue_ != nullptr) api()->ReleaseCommandQueue(queue_);
}

Device::~Device() {
  if (queue_ != nullptr) api()->Finish(queue_);
  release();
}

void Device::count_call() {
  if (calls_left_ == 0) throw DeviceFailure("the OpenCL device was told to fail");
  if (calls_left_ > 0) --calls_left_;
}

Buffer Device::make(std::size_t bytes) {
  count_call();
  ++buffers_made_;
  return {context_, std::max<std::size_t>(bytes, 64)};
}

void Device::write(const Buffer& to, const void* from, std::size_t bytes) {
  count_call();
  if (bytes > 0)
    check(api()->EnqueueWriteBuffer(queue_, to.memory(), CL_TRUE, 0, bytes, from, 0, nullptr, nullptr),
          "clEnqueueWriteBuffer");
}

void Device::read(const Buffer& from, void* to, std::size_t bytes) {
  count_call();
  if (bytes > 0)
    check(api()->EnqueueReadBuffer(queue_, from.memory(), CL_TRUE, 0, bytes, to, 0, nullptr, nullptr),
          "clEnqueueReadBuffer");
}

void Device::copy(const Buffer& from, const Buffer& to, std::size_t bytes) {
  count_call();
  check(api()->EnqueueCopyBuffer(queue_, from.memory(), to.memory(), 0, 0, bytes, 0, nullptr, nullptr),
        "clEnqueueCopyBuffer");
}

void Device::fill_zero(const Buffer& to, std::size_t bytes) {
  count_call();
  const cl_int zero = 0;
  check(api()->EnqueueFillBuffer(queue_, to.memory(), &zero, sizeof zero, 0, bytes, 0, nullptr, nullptr),
        "clEnqueueFillBuffer");
}

void Device::flush() {
  count_call();
  check(api()->Flush(queue_), "clFlush");
}

void Device::set_argument(Kernel kernel, cl_uint number, const Buffer& buffer) {
  check(api()->SetKernelArg(kernels_[std::size_t(kernel)], number, sizeof(cl_mem), &buffer.memory()), "clSetKernelArg");
}
void Device::set_argument(Kernel kernel, cl_uint number, int value) {
  const cl_int v = value;
  check(api()->SetKernelArg(kernels_[std::size_t(kernel)], number, sizeof v, &v), "clSetKernelArg");
}
void Device::set_argument(Kernel kernel, cl_uint number, double value) {
  check(api()->SetKernelArg(kernels_[std::size_t(kernel)], number, sizeof value, &value), "clSetKernelArg");
}

void Device::enqueue(Kernel kernel, std::size_t groups, int items) {
  count_call();
  const std::size_t local = std::size_t(items), global = groups * local;
  check(api()->EnqueueNDRangeKernel(queue_, kernels_[std::size_t(kernel)], 1, nullptr, &global, &local, 0, nullptr,
                                    nullptr),
        "clEnqueueNDRangeKernel");
}

}  // namespace insula::opencl
