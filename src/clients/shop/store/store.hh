// SPDX-License-Identifier: GPL-2.0-or-later
// The tables of a shop in PostgreSQL.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "clients/shop/reading.hh"
#include "clients/shop/store/database.hh"

namespace mw::shop {

struct StoreSettings {
    std::string database;  ///< connection string for libpq
    /// Two collectors with one name never write at the same time: the second one waits.
    std::string collector;
    int keep_days = 0;  ///< older days are removed; 0: never
};

/// Creates and updates the tables: all missing steps, or none.
Result<> migrate(Database &database);

/// All calls come from one thread.
class Store {
  public:
    /// Connects, updates the tables, and takes the lock of the collector's name.
    static Result<Store> open(const StoreSettings &settings);

    /// Stores the complete batch or nothing; values that are already stored are not repeated. `series`: all
    /// known series, by number. After an error the store cannot be used further.
    Result<> store(const Batch &batch, const std::vector<Series> &series);
    /// Removes days that are too old, and creates future days. Called once in each hour, and at the start.
    Result<> tend();

  private:
    Store(Database database, StoreSettings settings)
        : database_(std::move(database)), settings_(std::move(settings)) {}
    Result<> lock();
    Result<> write(const Batch &batch, const std::vector<Series> &series);
    Result<> find_ids(const Batch &batch, const std::vector<Series> &series);
    Result<int> machine_id(const MachineName &name);
    Result<> make_days(const std::vector<Reading> &readings);
    Result<> make_day(std::int64_t day);
    Result<> write_readings(const std::vector<Reading> &readings, const std::vector<Series> &series);
    Result<> write_presences(const std::vector<Presence> &presences);
    Result<> write_census(const Census &census);

    Database database_;
    StoreSettings settings_;
    std::map<MachineName, int> machines_;
    std::vector<std::int32_t> ids_;  ///< ids of metrics, by the number of their series; 0: not known
    std::set<std::int64_t> days_;    ///< days since 1970 that have a partition
};

}  // namespace mw::shop
