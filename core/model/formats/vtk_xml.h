// SPDX-License-Identifier: GPL-3.0-or-later
// VTK XML files of any type ("VTK XML Formats", VTK documentation): a reader says which arrays of which sections it wants, and gets their
// numbers piece by piece, however they are stored.
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

/// What is read of a file besides its points.
struct VtkXmlWanted {
  struct Section {
    std::string name;                  ///< element of a piece, such as "Cells"
    std::string count;                 ///< attribute of the piece that says how many it has, such as "NumberOfCells"
    bool needed = true;                ///< false: a piece without that attribute has none
    std::vector<std::string> arrays;   ///< names of its data arrays; others are passed over
  };
  std::string type;                    ///< of the root: "UnstructuredGrid", "PolyData"
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
    std::map<std::string, Section> sections;  ///< all that are wanted
  };

  /// Reads the structure; `bytes` must outlive this. Throws InputError: another type, malformed, truncated, a byte order, header type or
  /// compressor that is not known, a document type, an array that is there twice.
  VtkXmlFile(const std::filesystem::path& file, std::string_view bytes, const VtkXmlWanted& wanted);

  const std::vector<Piece>& pieces() const { return pieces_; }
  /// x, y, z of each point, in the file's unit. Throws InputError: missing, short, of another count.
  std::vector<double> positions(const Piece& piece) const;
  /// A section's array of whole numbers, `expected` of them (negative: any). Throws InputError: the same, or one that is not whole.
  std::vector<std::int64_t> whole(const Section& section, const std::string& array, std::int64_t expected) const;

 private:
  std::filesystem::path file_;
  VtuFormat format_;
  std::vector<Piece> pieces_;
};

}  // namespace insula
