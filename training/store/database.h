// SPDX-License-Identifier: GPL-3.0-or-later
// An SQLite file and its statements. Every failure is thrown as InputError with the file's name.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace insula::training {

/// What SQLite has done for the statements of a connection, to see that a query does not read more than it must.
struct DatabaseWork {
  std::int64_t queries = 0;  ///< statements that were begun
  std::int64_t rows = 0;     ///< rows that they gave
  std::int64_t scanned = 0;  ///< steps through a table that no index served
  std::int64_t steps = 0;    ///< instructions of SQLite's virtual machine
};

/// A prepared statement. Parameters are numbered from 1, columns from 0.
class Statement {
 public:
  /// Binds all parameters from the first one on.
  template <class... Values>
  Statement& bind(const Values&... values) {
    int at = 0;
    (set(++at, values), ...);
    return *this;
  }
  /// The next row. False: there is none, and the statement can be bound again.
  bool step();
  /// Runs it to its end.
  void run() {
    while (step()) {
    }
  }

  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  bool null(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* s) const;
  };
  Statement(sqlite3* database, sqlite3_stmt* statement, std::string file, DatabaseWork& work)
      : database_(database), statement_(statement), file_(std::move(file)), work_(&work) {}
  void count(int code);
  void set(int at, std::int64_t value);
  void set(int at, int value) { set(at, std::int64_t(value)); }
  void set(int at, double value);
  void set(int at, std::string_view value);
  void set(int at, const std::string& value) { set(at, std::string_view(value)); }
  void set(int at, const char* value) { set(at, std::string_view(value)); }
  void set_null(int at);
  template <class T>
  void set(int at, const std::optional<T>& value) {
    if (value) set(at, *value);
    else set_null(at);
  }
  void check(int code) const;

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  std::string file_;
  DatabaseWork* work_;
};

class Database {
 public:
  /// Opens the file, or creates it. Several processes may use it at once: readers never wait, and a writer waits up to
  /// five seconds for another. A transaction that has ended outlives the death of the process and of the machine.
  explicit Database(const std::filesystem::path& file);

  Statement prepare(std::string_view sql) const;
  /// Statements without parameters and results, separated by semicolons.
  void run(const std::string& sql) const;
  std::int64_t last_id() const;
  /// Number of rows that the last statement changed.
  std::int64_t changes() const;
  /// Copies everything into another file while this one is in use. An existing file is replaced when the copy is whole.
  void back_up(const std::filesystem::path& to) const;
  const std::string& file() const { return file_; }
  /// Since it was opened.
  const DatabaseWork& work() const { return *work_; }

 private:
  struct Close {
    void operator()(sqlite3* d) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> database_;
  std::unique_ptr<DatabaseWork> work_ = std::make_unique<DatabaseWork>();
};

/// Everything until commit(), or nothing. It takes the writer's place at once, so it cannot fail halfway for another's
/// sake.
class Transaction {
 public:
  explicit Transaction(const Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  const Database& database_;
  bool open_ = true;
};

}  // namespace insula::training
