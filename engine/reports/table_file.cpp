// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/table_file.h"

#include <cerrno>
#include <cstring>

#include "core/base/input_error.h"
#include "engine/reports/csv.h"

namespace insula {

TableFile::TableFile(const std::filesystem::path& folder, const std::string& name, const std::string& format,
                     std::vector<std::string> columns)
    : file_(folder / (name + "." + format)),
      out_(file_, std::ios::binary | std::ios::trunc),
      json_(format == "json"),
      columns_(std::move(columns)) {
  if (json_) out_ << "[";
  else
    for (std::size_t i = 0; i < columns_.size(); ++i) out_ << (i ? "," : "") << csv_text(columns_[i]);
}

void TableFile::row(const std::vector<Json>& values) {
  if (json_) {
    Json object;
    for (std::size_t i = 0; i < values.size(); ++i) object[columns_[i]] = values[i];
    out_ << (rows_++ ? ",\n " : "\n ") << object.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  out_ << "\n";
  for (std::size_t i = 0; i < values.size(); ++i) {
    out_ << (i ? "," : "");
    if (values[i].is_string()) out_ << csv_text(values[i].get<std::string>());
    else if (!values[i].is_null()) out_ << values[i].dump();
  }
}

std::filesystem::path TableFile::close() {
  out_ << (json_ ? "\n]\n" : "\n");
  out_.close();
  if (!out_) throw InputError(file_.string() + ": cannot be written: " + std::strerror(errno));
  return file_;
}

}  // namespace insula
