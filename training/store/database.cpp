// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/database.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include "core/base/input_error.h"

namespace insula::training {
namespace fs = std::filesystem;
namespace {

constexpr int writer_patience_ms = 5000;

void check(sqlite3* database, const std::string& file, int code) {
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  const char* why = database ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  throw InputError(fmt::format("{}: {}", file, why));
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
void Statement::check(int code) const { training::check(database_, file_, code); }

void Statement::count(int code) {
  work_->rows += code == SQLITE_ROW;
  work_->scanned += sqlite3_stmt_status(statement_.get(), SQLITE_STMTSTATUS_FULLSCAN_STEP, 1);
  work_->steps += sqlite3_stmt_status(statement_.get(), SQLITE_STMTSTATUS_VM_STEP, 1);
}

bool Statement::step() {
  if (!sqlite3_stmt_busy(statement_.get())) ++work_->queries;
  const int code = sqlite3_step(statement_.get());
  count(code);
  if (code == SQLITE_ROW) return true;
  const int reset = sqlite3_reset(statement_.get());
  check(code == SQLITE_DONE ? reset : code);
  return false;
}

void Statement::set(int at, std::int64_t value) { check(sqlite3_bind_int64(statement_.get(), at, value)); }
void Statement::set(int at, double value) { check(sqlite3_bind_double(statement_.get(), at, value)); }
void Statement::set_null(int at) { check(sqlite3_bind_null(statement_.get(), at)); }
void Statement::set(int at, std::string_view value) {
  check(sqlite3_bind_text(statement_.get(), at, value.data(), int(value.size()), SQLITE_TRANSIENT));
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }
bool Statement::null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }
std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return bytes ? std::string(bytes, std::size_t(sqlite3_column_bytes(statement_.get(), column))) : std::string();
}

void Database::Close::operator()(sqlite3* d) const { sqlite3_close_v2(d); }

Database::Database(const fs::path& file) : file_(file.string()) {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(file_.c_str(), &opened,
                                   SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_FULLMUTEX, nullptr);
  database_.reset(opened);
  check(opened, file_, code);
  sqlite3_extended_result_codes(opened, 1);
  sqlite3_busy_timeout(opened, writer_patience_ms);
  // The log beside the file lets readers go on while somebody writes. Deleted rows are overwritten, since forgetting a
  // person means that nothing of him stays.
  run("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON; PRAGMA secure_delete=ON;");
}

Statement Database::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  check(database_.get(), file_, sqlite3_prepare_v2(database_.get(), sql.data(), int(sql.size()), &statement, nullptr));
  return {database_.get(), statement, file_, *work_};
}

void Database::run(const std::string& sql) const {
  check(database_.get(), file_, sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Database::last_id() const { return sqlite3_last_insert_rowid(database_.get()); }
std::int64_t Database::changes() const { return sqlite3_changes64(database_.get()); }

void Database::back_up(const fs::path& to) const {
  const fs::path partial = to.string() + fmt::format(".{}.partial", ::getpid());
  std::error_code ignored;
  fs::remove(partial, ignored);
  {
    Database copy(partial);
    sqlite3_backup* backup = sqlite3_backup_init(copy.database_.get(), "main", database_.get(), "main");
    if (!backup) check(copy.database_.get(), copy.file_, sqlite3_errcode(copy.database_.get()));
    // All pages in one step: a writer in between would make the copy begin again.
    const int code = sqlite3_backup_step(backup, -1);
    sqlite3_backup_finish(backup);
    check(copy.database_.get(), copy.file_, code);
    copy.run("PRAGMA journal_mode=DELETE;");  // one file, that can be carried away
  }
  std::error_code error;
  fs::rename(partial, to, error);
  if (error) throw InputError(fmt::format("{}: {}", to.string(), error.message()));
}

Transaction::Transaction(const Database& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const InputError&) {
    // The failure that ended it has rolled it back already.
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

}  // namespace insula::training
