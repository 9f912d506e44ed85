// SPDX-License-Identifier: GPL-3.0-or-later
// VTK XML files of any type ("VTK XML Formats", VTK documentation). A reader names the arrays and sections that it
// wants. It gets their numbers piece by piece, for every encoding.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/formats/vtu_data.h"

namespace insula {

/// The parts of a file that are read besides its points.
struct VtkXmlWanted {
  struct Section {
    std::string name;                 ///< element of a piece, such as "Cells"
    std::string count;                ///< attribute of the piece with its number of entries, such as "NumberOfCells"
    bool needed = true;               ///< false: a piece without that attribute has no entries
    std::vector<std::string> arrays;  ///< names of its data arrays; others are skipped
  };
  std::string type;  ///< of the root: "UnstructuredGrid", "PolyData"
  std::vector<Section> sections;
};

class VtkXmlFile {
 public:
  struct Section {
    std::int64_t count = 0;
    std::map<std::string, VtuArray> arrays;
  };
  struct Piece {
    std::int64_t points = 0;
    std::optional<VtuArray> positions;
    std::map<std::string, Section> sections;  ///< all wanted sections
  };

  /// Reads the structure; `bytes` must outlive this object. Throws InputError: another type, malformed, truncated, an
  /// unknown byte order, header type or compressor, a document type, or a repeated array.
  VtkXmlFile(const std::filesystem::path& file, std::string_view bytes, const VtkXmlWanted& wanted);

  const std::vector<Piece>& pieces() const { return pieces_; }
  /// x, y, z of each point, in the file's unit. Throws InputError: missing, too short, or another count.
  std::vector<double> positions(const Piece& piece) const;
  /// A section's array of integers, `expected` of them (negative: any). Throws InputError: the same, or a value that is
  /// not an integer.
  std::vector<std::int64_t> whole(const Section& section, const std::string& array, std::int64_t expected) const;

 private:
  std::filesystem::path file_;
  VtuFormat format_;
  std::vector<Piece> pieces_;
};

}  // namespace insula
