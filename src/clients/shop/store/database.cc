// SPDX-License-Identifier: GPL-2.0-or-later
// Implemented with libpq, which only this file includes.
#include "clients/shop/store/database.hh"

#include <array>
#include <bit>
#include <libpq-fe.h>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::shop {

Rows::Rows(pg_result *result) : result_(result, PQclear) {}
int Rows::count() const {
    return PQntuples(result_.get());
}
int Rows::columns() const {
    return PQnfields(result_.get());
}
std::size_t Rows::written() const {
    return parse_uint(PQcmdTuples(result_.get())).value_or(0);
}
std::optional<std::string> Rows::text(int row, int column) const {
    return PQgetisnull(result_.get(), row, column) == 1
               ? std::nullopt
               : std::optional<std::string>(PQgetvalue(result_.get(), row, column));
}
std::string Rows::name(int column) const {
    return PQfname(result_.get(), column);
}

ArrayWriter::ArrayWriter(std::uint32_t element_type, std::size_t count, bool hasNulls) {
    constexpr int DIMENSIONS = 1, LOWEST_INDEX = 1, WIDTH = 4;
    put(DIMENSIONS, WIDTH);
    put(hasNulls ? 1 : 0, WIDTH);
    put(element_type, WIDTH);
    put(count, WIDTH);
    put(LOWEST_INDEX, WIDTH);
}
void ArrayWriter::put(std::uint64_t value, int bytes) {
    constexpr unsigned BITS = 8;
    for (int i = bytes - 1; i >= 0; --i) {
        bytes_ += static_cast<char>(value >> (BITS * static_cast<unsigned>(i)));
    }
}
void ArrayWriter::null() {
    put(~std::uint64_t{0}, 4);
}
void ArrayWriter::int32(std::int32_t value) {
    put(4, 4);
    put(static_cast<std::uint32_t>(value), 4);
}
void ArrayWriter::int64(std::int64_t value) {
    put(8, 4);
    put(std::bit_cast<std::uint64_t>(value), 8);
}
void ArrayWriter::float64(double value) {
    put(8, 4);
    put(std::bit_cast<std::uint64_t>(value), 8);
}
void ArrayWriter::boolean(bool value) {
    put(1, 4);
    put(value ? 1 : 0, 1);
}
void ArrayWriter::text(std::string_view value) {
    put(value.size(), 4);
    bytes_ += value;
}

void Database::Close::operator()(pg_conn *connection) const {
    PQfinish(connection);
}

Error Database::error(const char *what) const {
    return Error{fmt::format("{}: {}", what, trim(PQerrorMessage(connection_.get())))};
}

Result<Database> Database::open(const std::string &connection) {
    // The settings of the connection come last, because they may override others.
    constexpr std::array<const char *, 9> KEYS{"connect_timeout",  "keepalives_idle",  "keepalives_interval",
                                               "keepalives_count", "tcp_user_timeout", "application_name",
                                               "client_encoding",  "dbname",           nullptr};
    const std::array<const char *, 9> values{
        "5", "10", "5", "4", "30000", "millwright shop", "UTF8", connection.c_str(), nullptr};
    constexpr int EXPAND_DBNAME = 1;
    Database database(PQconnectdbParams(KEYS.data(), values.data(), EXPAND_DBNAME));
    if (PQstatus(database.connection_.get()) != CONNECTION_OK) {
        return std::unexpected(database.error("cannot connect to the database"));
    }
    PQsetNoticeProcessor(database.connection_.get(), [](void *, const char *) {}, nullptr);
    return database;
}

Result<> Database::run(const std::string &sql) {
    const Rows rows(PQexec(connection_.get(), sql.c_str()));
    return PQresultStatus(rows.get()) == PGRES_COMMAND_OK || PQresultStatus(rows.get()) == PGRES_TUPLES_OK
               ? Result<>{}
               : std::unexpected(error("the database rejects a statement"));
}

Result<Rows> Database::ask(const std::string &sql, std::span<const Parameter> parameters) {
    std::vector<const char *> values;
    std::vector<int> lengths, formats;
    for (const Parameter &one : parameters) {
        values.push_back(one.isNull ? nullptr : one.bytes.c_str());
        lengths.push_back(static_cast<int>(one.bytes.size()));
        formats.push_back(one.isBinary ? 1 : 0);
    }
    constexpr int AS_TEXT = 0;
    const Rows rows(PQexecParams(connection_.get(), sql.c_str(), static_cast<int>(values.size()), nullptr,
                                 values.data(), lengths.data(), formats.data(), AS_TEXT));
    if (PQresultStatus(rows.get()) != PGRES_COMMAND_OK && PQresultStatus(rows.get()) != PGRES_TUPLES_OK) {
        return std::unexpected(error("the database rejects a statement"));
    }
    return rows;
}

}  // namespace mw::shop
