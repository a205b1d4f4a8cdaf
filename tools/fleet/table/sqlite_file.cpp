#include <waymark/tools/fleet/table/sqlite_file.hpp>

#include <cmath>
#include <memory>

#include <sqlite3.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <waymark/core/base/error.hpp>

namespace waymark::fleet {
namespace {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct EndStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// A database in memory.
class Database {
 public:
  Database() {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open(":memory:", &opened);
    database_.reset(opened);
    require(code == SQLITE_OK);
  }

  void execute(const std::string& sql) {
    require(sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  }

  std::unique_ptr<sqlite3_stmt, EndStatement> prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    require(sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) == SQLITE_OK);
    return std::unique_ptr<sqlite3_stmt, EndStatement>(statement);
  }

  /// Inserts a row of words, then numbers.
  void insert(sqlite3_stmt* statement, const std::vector<std::string>& words,
              const std::vector<double>& numbers = {}) {
    int place = 0;
    for (const std::string& word : words)
      require(sqlite3_bind_text(statement, ++place, word.data(), static_cast<int>(word.size()),
                                SQLITE_TRANSIENT) == SQLITE_OK);
    for (const double number : numbers) bind(statement, ++place, number);
    require(sqlite3_step(statement) == SQLITE_DONE);
    require(sqlite3_reset(statement) == SQLITE_OK && sqlite3_clear_bindings(statement) == SQLITE_OK);
  }

  std::string bytes() {
    sqlite3_int64 size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> image(
        sqlite3_serialize(database_.get(), "main", &size, 0), sqlite3_free);
    if (image == nullptr) throw OutputError("SQLite: there is not enough memory for the database");
    return {image.get(), image.get() + size};
  }

 private:
  void bind(sqlite3_stmt* statement, int place, double number) {
    const int code = std::isfinite(number) ? sqlite3_bind_double(statement, place, number)
                                           : sqlite3_bind_null(statement, place);
    require(code == SQLITE_OK);
  }

  void require(bool succeeded) {
    if (!succeeded) throw OutputError(fmt::format("SQLite: {}", sqlite3_errmsg(database_.get())));
  }

  std::unique_ptr<sqlite3, CloseDatabase> database_;
};

std::string placeholders(std::size_t count) {
  std::string text = "?";
  for (std::size_t i = 1; i < count; ++i) text += ", ?";
  return text;
}

void write_drives(const Fleet& fleet, Database& database) {
  const std::vector<std::string> words = word_columns();
  std::string sql = "CREATE TABLE drives (";
  for (const std::string& word : words) sql += word + (word == "exit_code" ? " INTEGER, " : " TEXT, ");
  for (const Column& column : columns()) sql += fmt::format("{} REAL, ", column.name);
  database.execute(sql + "PRIMARY KEY (drive, modeling))");
  const auto insert =
      database.prepare("INSERT INTO drives VALUES (" + placeholders(words.size() + columns().size()) + ")");
  for (const DriveRecord& record : fleet.records) {
    if (record.rows.empty()) database.insert(insert.get(), words_of(record, ""));
    for (const ModelingRow& row : record.rows)
      database.insert(insert.get(), words_of(record, row.modeling), row.numbers);
  }
}

void write_columns(Database& database) {
  database.execute("CREATE TABLE columns (name TEXT PRIMARY KEY, about TEXT)");
  const auto insert = database.prepare("INSERT INTO columns VALUES (?, ?)");
  for (const Column& column : columns()) database.insert(insert.get(), {column.name, column.about});
}

void write_plan(const FleetPlan& plan, Database& database) {
  database.execute("CREATE TABLE fleet (key TEXT PRIMARY KEY, value TEXT)");
  const auto insert = database.prepare("INSERT INTO fleet VALUES (?, ?)");
  database.insert(insert.get(), {"label", plan.label});
  database.insert(insert.get(), {"options", fmt::format("{}", fmt::join(plan.options, " "))});
  database.insert(insert.get(), {"drives", std::to_string(plan.drives.size())});
}

}  // namespace

std::string sqlite_bytes(const Fleet& fleet) {
  Database database;
  database.execute("BEGIN");
  write_drives(fleet, database);
  write_columns(database);
  write_plan(fleet.plan, database);
  database.execute("COMMIT");
  return database.bytes();
}

std::string sqlite_version() {
  return sqlite3_libversion();
}

}  // namespace waymark::fleet
