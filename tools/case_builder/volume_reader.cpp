// SPDX-License-Identifier: GPL-3.0-or-later
// Reads volumes through ITK. Its readers are used one by one, without factories and image templates, which keeps
// this quick to compile. It includes no Eigen, since ITK may bring another version of it.
#include "tools/case_builder/volume_reader.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/dicom_check.h"

namespace insula::case_builder {
namespace {

namespace fs = std::filesystem;
using mesh_tool::operator-, mesh_tool::operator*, mesh_tool::dot, mesh_tool::cross, mesh_tool::norm;
constexpr double max_voxels = 1e9;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string lower_name(const fs::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return name;
}

template <class T>
void widen(const std::vector<char>& bytes, std::vector<float>& out) {
  const T* in = reinterpret_cast<const T*>(bytes.data());
  out.assign(in, in + bytes.size() / sizeof(T));
}

/// All voxels of one file as floats.
std::vector<float> voxels(const fs::path& file, itk::ImageIOBase& io) {
  using C = itk::IOComponentEnum;
  std::vector<char> bytes(std::size_t(io.GetImageSizeInBytes()));
  io.Read(bytes.data());
  std::vector<float> out;
  switch (io.GetComponentType()) {
    case C::UCHAR: widen<unsigned char>(bytes, out); break;
    case C::CHAR: widen<signed char>(bytes, out); break;
    case C::USHORT: widen<unsigned short>(bytes, out); break;
    case C::SHORT: widen<short>(bytes, out); break;
    case C::UINT: widen<unsigned>(bytes, out); break;
    case C::INT: widen<int>(bytes, out); break;
    case C::ULONG: widen<unsigned long>(bytes, out); break;
    case C::LONG: widen<long>(bytes, out); break;
    case C::FLOAT: widen<float>(bytes, out); break;
    case C::DOUBLE: widen<double>(bytes, out); break;
    default: fail(file, "has voxels of a kind that is not read; store whole numbers or floats");
  }
  return out;
}

/// Position of the first voxel and steps along the three axes of a volume, mm.
struct Placement {
  mesh_tool::Vec3 origin{};
  std::array<mesh_tool::Vec3, 3> axis{};
};

/// Sets the map from indices to right-anterior-superior millimetres. ITK gives left-posterior-superior ones.
void place(mesh_tool::NiftiVolume& v, const fs::path& file, Placement p) {
  for (mesh_tool::Vec3* x : {&p.origin, &p.axis[0], &p.axis[1], &p.axis[2]}) (*x)[0] *= -1, (*x)[1] *= -1;
  const auto& [a, b, c] = p.axis;
  const double volume = dot(a, cross(b, c));
  if (!(std::abs(volume) > 1e-12) || !std::isfinite(volume) || !std::isfinite(norm(p.origin)))
    fail(file, "its axes or spacing span no volume");
  // Rows of the inverse matrix.
  const std::array<mesh_tool::Vec3, 3> inverse{1 / volume * cross(b, c), 1 / volume * cross(c, a),
                                               1 / volume * cross(a, b)};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) v.to_world[4 * r + k] = p.axis[k][r], v.from_world[4 * r + k] = inverse[r][k];
    v.to_world[4 * r + 3] = p.origin[r];
    v.from_world[4 * r + 3] = -dot(inverse[r], p.origin);
  }
}

void check_size(const fs::path& file, const std::array<int, 3>& n) {
  for (const int k : n)
    if (k < 2)
      fail(file, "is no volume: it has " + std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " +
                     std::to_string(n[2]) + " voxels");
  if (double(n[0]) * n[1] * n[2] > max_voxels)
    fail(file, "has more than 1,000 million voxels; cut out the region around the aneurysm first");
}

void read_header(const fs::path& file, itk::ImageIOBase& io) {
  if (!io.CanReadFile(file.c_str())) fail(file, "is not what its name says, or is damaged");
  io.SetFileName(file.string());
  io.ReadImageInformation();
  if (io.GetNumberOfComponents() != 1)
    fail(file, "has " + std::to_string(io.GetNumberOfComponents()) +
                   " values a voxel; a volume of labels or of grey values has one");
}

mesh_tool::NiftiVolume read_file(const fs::path& file, itk::ImageIOBase& io) {
  read_header(file, io);
  unsigned dimensions = io.GetNumberOfDimensions();
  while (dimensions > 3 && io.GetDimensions(dimensions - 1) == 1) --dimensions;
  if (dimensions != 3)
    fail(file,
         "has " + std::to_string(dimensions) + " dimensions; a volume has three (cut one time or slice out of it)");
  mesh_tool::NiftiVolume v;
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a)
    region.SetSize(a, io.GetDimensions(a)), region.SetIndex(a, 0);
  for (unsigned a = 0; a < 3; ++a) v.size[a] = int(std::min<std::size_t>(io.GetDimensions(a), 1'000'000));
  check_size(file, v.size);
  io.SetIORegion(region);
  v.value = voxels(file, io);
  const std::size_t count = std::size_t(v.size[0]) * std::size_t(v.size[1]) * std::size_t(v.size[2]);
  if (v.value.size() < count) fail(file, "ends early: it holds fewer voxels than its header says");
  v.value.resize(count);
  Placement placement;
  for (unsigned a = 0; a < 3; ++a) {
    const std::vector<double> d = io.GetDirection(a);
    for (unsigned r = 0; r < 3; ++r) placement.axis[a][r] = d[r] * io.GetSpacing(a);
    placement.origin[a] = io.GetOrigin(a);
  }
  place(v, file, placement);
  return v;
}

mesh_tool::NiftiVolume read_series(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.file_size() < (std::uintmax_t(1) << 30)) check_dicom(entry.path());
  auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetDirectory(folder.string());
  const std::vector<std::string> series = names->GetSeriesUIDs();
  if (series.empty()) fail(folder, "holds no DICOM images");
  if (series.size() > 1) {
    std::string list;
    for (const std::string& s : series)
      list += "\n  " + std::to_string(names->GetFileNames(s).size()) + " images in " + in_quotes(s);
    fail(folder, "holds " + std::to_string(series.size()) + " DICOM series; put one into a folder of its own:" + list);
  }
  const std::vector<std::string> files = names->GetFileNames(series[0]);
  mesh_tool::NiftiVolume v;
  std::vector<mesh_tool::Vec3> origins;
  Placement placement;
  for (std::size_t k = 0; k < files.size(); ++k) {
    auto io = itk::GDCMImageIO::New();
    read_header(files[k], *io);
    const unsigned depth = io->GetNumberOfDimensions() > 2 ? unsigned(io->GetDimensions(2)) : 1;
    if (depth > 1 && files.size() == 1)
      return read_file(files[0], *itk::GDCMImageIO::New());  // one file that holds all slices
    if (depth > 1) fail(files[k], "holds several slices beside other files of its series");
    const std::array<int, 3> size{int(io->GetDimensions(0)), int(io->GetDimensions(1)), int(files.size())};
    if (k == 0) v.size = size, check_size(folder, size);
    if (size != v.size) fail(files[k], "has another size than the images before it");
    itk::ImageIORegion region(io->GetNumberOfDimensions());
    for (unsigned a = 0; a < io->GetNumberOfDimensions(); ++a)
      region.SetSize(a, io->GetDimensions(a)), region.SetIndex(a, 0);
    io->SetIORegion(region);
    const std::vector<float> slice = voxels(files[k], *io);
    v.value.insert(v.value.end(), slice.begin(), slice.begin() + std::ptrdiff_t(size[0]) * size[1]);
    origins.push_back({io->GetOrigin(0), io->GetOrigin(1), io->GetOrigin(2)});
    for (unsigned a = 0; a < 2; ++a)
      for (unsigned r = 0; r < 3; ++r) placement.axis[a][r] = io->GetDirection(a)[r] * io->GetSpacing(a);
  }
  for (std::size_t k = 1; k < origins.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)  // GDCM leaves them in any order then
      if (norm(origins[k] - origins[l]) < 1e-4)
        fail(folder, "two of its slices lie at the same place (" + fs::path(files[l]).filename().string() + " and " +
                         fs::path(files[k]).filename().string() + "): leave one out");
  const mesh_tool::Vec3 between = 1 / double(origins.size() - 1) * (origins.back() - origins.front());
  for (std::size_t k = 1; k < origins.size(); ++k)
    if (norm(origins[k] - origins[k - 1] - between) > 0.1 * norm(between) + 1e-3)
      fail(folder, "its slices do not stand at even distances (between " + fs::path(files[k - 1]).filename().string() +
                       " and " + fs::path(files[k]).filename().string() + "): is one missing?");
  placement.origin = origins.front();
  placement.axis[2] = between;
  place(v, folder, placement);
  return v;
}

/// ITK takes a NIfTI file that ends early for one that ends in zeros.
void check_length(const fs::path& file) {
  const gzFile in = gzopen(file.c_str(), "rb");  // plain files too
  if (!in) fail(file, "cannot be opened");
  std::vector<unsigned char> buffer(std::size_t(1) << 20);
  unsigned char head[352] = {};
  double length = 0;
  bool sound = true;
  for (int n; (n = gzread(in, buffer.data(), unsigned(buffer.size()))) != 0;) {
    if (n < 0) {
      sound = false;
      break;
    }
    if (length == 0) std::memcpy(head, buffer.data(), std::min<std::size_t>(sizeof head, std::size_t(n)));
    length += n;
  }
  sound = gzclose(in) == Z_OK && sound;
  if (!sound) fail(file, "ends early, or its compression is damaged");
  if (length < 352) fail(file, "ends early: it is shorter than a NIfTI header");
  const bool swap = head[40] == 0 && head[41] != 0;  // the number of dimensions, 1 to 7
  const auto whole = [&](std::size_t at) {
    return std::int16_t(swap ? head[at] << 8 | head[at + 1] : head[at + 1] << 8 | head[at]);
  };
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < 4; ++k) bits |= std::uint32_t(head[108 + (swap ? 3 - k : k)]) << (8 * k);
  float offset;
  std::memcpy(&offset, &bits, 4);
  double wanted = whole(72) / 8.0;
  for (int d = 1; d <= whole(40) && d < 8; ++d) wanted *= std::max<int>(1, whole(std::size_t(40 + 2 * d)));
  if (std::memcmp(head + 344, "n+1", 3) == 0 && length < double(offset) + wanted)
    fail(file, "ends early: its header announces " + std::to_string(std::int64_t(wanted)) + " bytes of voxels, and " +
                   std::to_string(std::int64_t(length - double(offset))) + " are there");
}

/// And so it does with MetaImage. `bytes`: of the voxels, uncompressed.
void check_meta_length(const fs::path& file, double bytes) {
  std::ifstream in(file, std::ios::binary);
  std::string line, data;
  bool compressed = false;
  double wanted = bytes, skipped = 0;
  while (data.empty() && std::getline(in, line) && line.size() < 4096) {
    const std::size_t sign = line.find('=');
    if (sign == std::string::npos) continue;
    const std::string key(trim(line.substr(0, sign))), value(trim(line.substr(sign + 1)));
    if (key == "CompressedData") compressed = value == "True" || value == "true" || value == "1";
    if (key == "CompressedDataSize") parse_double(value, wanted);
    if (key == "HeaderSize") parse_double(value, skipped);
    if (key == "ElementDataFile") data = value;
  }
  if (data.empty() || data == "LIST" || data.find('%') != std::string::npos || (compressed && wanted == bytes))
    return;  // ITK reads those file by file
  std::error_code error;
  const fs::path holds = data == "LOCAL" || data == "Local" || data == "local" ? file : file.parent_path() / data;
  const double there =
      double(fs::file_size(holds, error)) - (holds == file ? double(in.tellg()) : std::max(0.0, skipped));
  if (error) fail(file, "its data file " + in_quotes(data) + " is not there");
  if (there < wanted)
    fail(holds, "ends early: " + std::to_string(std::int64_t(wanted)) + " bytes of voxels are announced, and " +
                    std::to_string(std::int64_t(there)) + " are there");
}

}  // namespace

mesh_tool::NiftiVolume read_volume(const fs::path& path) {
  itk::Object::SetGlobalWarningDisplay(false);  // what matters comes as an exception
  const std::string name = lower_name(path);
  try {
    if (fs::is_directory(path)) return read_series(path);
    if (!fs::exists(path)) fail(path, "does not exist");
    if (ends_with(name, ".dcm")) return read_series(path.parent_path().empty() ? fs::path(".") : path.parent_path());
    if (ends_with(name, ".mha") || ends_with(name, ".mhd")) {
      auto io = itk::MetaImageIO::New();
      read_header(path, *io);
      check_meta_length(path, double(io->GetImageSizeInBytes()));
      return read_file(path, *itk::MetaImageIO::New());
    }
    if (ends_with(name, ".nrrd")) return read_file(path, *itk::NrrdImageIO::New());
    check_length(path);
    return read_file(path, *itk::NiftiImageIO::New());
  } catch (const InputError&) {
    throw;
  } catch (const itk::ExceptionObject& e) {
    fail(path, "cannot be read, or ends early: " + shown(e.GetDescription()));
  } catch (const std::exception& e) {
    fail(path, "cannot be read: " + shown(e.what()));
  }
}

}  // namespace insula::case_builder
