// SPDX-License-Identifier: GPL-2.0-or-later
// A connection to PostgreSQL with libpq. Calls block; an error does not close the connection.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

struct pg_conn;
struct pg_result;

namespace mw::shop {

/// Rows of a result as text.
class Rows {
  public:
    explicit Rows(pg_result *result);
    int count() const;
    int columns() const;
    /// Number of rows written by an INSERT without WITH.
    std::size_t written() const;
    /// Nothing for NULL.
    std::optional<std::string> text(int row, int column) const;
    std::string name(int column) const;
    /// For calls of libpq.
    pg_result *get() const { return result_.get(); }

  private:
    std::shared_ptr<pg_result> result_;
};

/// A parameter of a statement: text, or the binary form of an array.
struct Parameter {
    std::string bytes;
    bool isBinary = false;
    bool isNull = false;
};

/// One-dimensional arrays in the binary form of PostgreSQL.
class ArrayWriter {
  public:
    /// `element_type` is its OID; `count` elements follow.
    ArrayWriter(std::uint32_t element_type, std::size_t count, bool hasNulls);
    void null();
    void int32(std::int32_t value);
    void int64(std::int64_t value);
    void float64(double value);
    void boolean(bool value);
    void text(std::string_view value);
    Parameter take() { return {std::move(bytes_), true, false}; }

  private:
    void put(std::uint64_t value, int bytes);
    std::string bytes_;
};

namespace oid {
inline constexpr std::uint32_t BOOL = 16, INT8 = 20, INT4 = 23, TEXT = 25, FLOAT8 = 701, TIMESTAMPTZ = 1184;
}  // namespace oid

class Database {
  public:
    /// `connection` in the form of libpq: "host=/run/postgresql dbname=shop", or a URI. Waits at most 5 s,
    /// and detects a lost computer in about 30 s.
    static Result<Database> open(const std::string &connection);
    Database(Database &&other) noexcept = default;
    Database &operator=(Database &&other) noexcept = default;
    ~Database() = default;

    /// Runs several statements without parameters.
    Result<> run(const std::string &sql);
    Result<Rows> ask(const std::string &sql, std::span<const Parameter> parameters = {});

  private:
    struct Close {
        void operator()(pg_conn *connection) const;
    };
    explicit Database(pg_conn *connection) : connection_(connection) {}
    Error error(const char *what) const;
    std::unique_ptr<pg_conn, Close> connection_;
};

}  // namespace mw::shop
