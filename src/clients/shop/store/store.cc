// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/store/store.hh"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/overloaded.hh"
#include "base/text.hh"
#include "clients/shop/store/schema.hh"

namespace mw::shop {
namespace {

constexpr std::int64_t MS_PER_DAY = 86'400'000;
/// 1 January 2000 in milliseconds, the epoch of PostgreSQL.
constexpr std::int64_t EPOCH_MS = 946'684'800'000;
/// Each day from 2020 to 2099 has its own partition; earlier and later days have one partition each.
constexpr std::int64_t FIRST_DAY = 18'262, END_DAY = 47'482;

std::int64_t timestamp(TimeMs at) {
    constexpr std::int64_t US_PER_MS = 1000;
    return (static_cast<std::int64_t>(at) - EPOCH_MS) * US_PER_MS;
}
std::int64_t day_of(TimeMs at) {
    return static_cast<std::int64_t>(at) / MS_PER_DAY;
}
std::int64_t today() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count() / MS_PER_DAY;
}
std::string date(std::int64_t day) {
    const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(day))};
    return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}
Parameter words(const std::string &text) {
    return {text, false, false};
}

/// True for a value from which notifications or runs of programs may follow; WRITE_EVENTS writes it.
bool isEvent(std::string_view metric) {
    constexpr std::array<std::string_view, 4> JOB_METRICS{"Execution", "Mode", "Program/Path",
                                                          "Program/Ended"};
    return metric.starts_with("Alarms/") || std::ranges::find(JOB_METRICS, metric) != JOB_METRICS.end();
}

constexpr const char *WRITE_READINGS =
    "INSERT INTO reading (metric, at, number, whole, text) "
    "SELECT * FROM unnest($1::int[], $2::timestamptz[], $3::float8[], $4::bigint[], $5::text[]) "
    "ON CONFLICT DO NOTHING";
/// Readings whose metric already has a different value at the same time.
constexpr const char *WRITE_SAME_TIMES =
    "SELECT count(*) FROM add_readings($1::int[], $2::timestamptz[], $3::float8[], $4::bigint[], $5::text[])";
/// Only a new row is reported to persons. A trigger calculates runs from job_reading.
constexpr const char *WRITE_EVENTS =
    "WITH fresh AS (SELECT * FROM add_readings($1::int[], $2::timestamptz[], $3::float8[], $4::bigint[], "
    "$5::text[])), "
    "age AS (SELECT metric, at, max(ms) AS ms FROM unnest($1::int[], $2::timestamptz[], $6::bigint[]) "
    "AS each (metric, at, ms) GROUP BY metric, at), "
    "named AS (SELECT fresh.*, machine, name, coalesce(ms, 0) AS ms FROM fresh "
    "JOIN metric ON metric.id = fresh.metric "
    "LEFT JOIN age ON age.metric = fresh.metric AND age.at = date_trunc('milliseconds', fresh.at)), "
    "job AS (INSERT INTO job_reading (metric, at, text) SELECT metric, at, text FROM named "
    "WHERE name NOT LIKE 'Alarms/%' ON CONFLICT DO NOTHING) "
    "INSERT INTO notification (machine, at, source, message, late) "
    "SELECT machine, at, name, text, ms * interval '1 ms' FROM named "
    "WHERE text <> '' AND (name LIKE 'Alarms/%' OR (name = 'Execution' AND text = 'PROGRAM_STOPPED')) "
    "ON CONFLICT DO NOTHING";
/// Presences in the order of arrival. A wrong clock is reported once a day.
constexpr const char *WRITE_PRESENCES =
    "WITH given AS (SELECT * FROM unnest($1::int[], $2::timestamptz[], $3::bool[], $4::bigint[]) WITH "
    "ORDINALITY "
    "AS each (machine, at, alive, ahead_s, place)), "
    "ordered AS (SELECT machine, alive, ahead_s, greatest(at, (SELECT max(at) FROM presence "
    "WHERE presence.machine = given.machine) + interval '1 ms' * "
    "row_number() OVER (PARTITION BY machine ORDER BY place)) AS at FROM given), "
    "fresh AS (INSERT INTO presence (machine, at, alive) SELECT machine, at, alive FROM ordered) "
    "INSERT INTO notification (machine, at, source, message) "
    "SELECT id, at, 'Contact', 'The machine is not connected.' FROM ordered "
    "JOIN machine ON machine.id = ordered.machine WHERE NOT alive AND device <> '' "
    "UNION ALL (SELECT DISTINCT ON (id) id, at, 'Clock', format('The clock of the machine is %s s %s. Set "
    "it: "
    "times of its values are wrong.', abs(ahead_s), CASE WHEN ahead_s > 0 THEN 'ahead' ELSE 'behind' END) "
    "FROM ordered JOIN machine ON machine.id = ordered.machine WHERE alive AND abs(ahead_s) > 60 AND "
    "device <> '' AND NOT EXISTS (SELECT FROM notification WHERE machine = ordered.machine "
    "AND source = 'Clock' AND received > now() - interval '1 day')) "
    "ON CONFLICT DO NOTHING";

/// Readings as the arrays of a statement.
class ReadingArrays {
  public:
    explicit ReadingArrays(std::size_t count)
        : metrics_(oid::INT4, count, false), times_(oid::TIMESTAMPTZ, count, false),
          numbers_(oid::FLOAT8, count, true), wholes_(oid::INT8, count, true), texts_(oid::TEXT, count, true),
          ages_(oid::INT8, count, false) {}
    void add(std::int32_t metric, const Reading &reading);
    std::array<Parameter, 6> take() {
        return {metrics_.take(), times_.take(), numbers_.take(), wholes_.take(), texts_.take(), ages_.take()};
    }

  private:
    ArrayWriter metrics_, times_, numbers_, wholes_, texts_, ages_;
};

}  // namespace

Result<> migrate(Database &database) {
    // One process at a time; a second process waits, and then finds nothing to do.
    auto done = database.run("BEGIN; SELECT pg_advisory_xact_lock(hashtext('millwright shop schema')); "
                             "CREATE TABLE IF NOT EXISTS schema_step (number integer PRIMARY KEY, "
                             "at timestamptz NOT NULL DEFAULT now())");
    if (!done.has_value()) {
        return done;
    }
    const auto newest = database.ask("SELECT coalesce(max(number), 0) FROM schema_step");
    if (!newest.has_value()) {
        return std::unexpected(newest.error());
    }
    const std::size_t from = parse_uint(newest->text(0, 0).value_or("")).value_or(0);
    if (from > SCHEMA_STEPS.size()) {
        return fail(fmt::format("the tables are of a newer version (step {}, this program knows {})", from,
                                SCHEMA_STEPS.size()),
                    {}, "start a collector of that version");
    }
    for (std::size_t i = from; i < SCHEMA_STEPS.size(); ++i) {
        done = database.run(std::string(SCHEMA_STEPS[i]) +
                            fmt::format("; INSERT INTO schema_step (number) VALUES ({})", i + 1));
        if (!done.has_value()) {
            return done;
        }
    }
    return database.run("COMMIT");
}

Result<Store> Store::open(const StoreSettings &settings) {
    auto database = Database::open(settings.database);
    if (!database.has_value()) {
        return std::unexpected(database.error());
    }
    if (const auto migrated = migrate(*database); !migrated.has_value()) {
        return std::unexpected(migrated.error());
    }
    Store store(std::move(*database), settings);
    if (const auto locked = store.lock(); !locked.has_value()) {
        return std::unexpected(locked.error());
    }
    if (const auto tended = store.tend(); !tended.has_value()) {
        return std::unexpected(tended.error());
    }
    return store;
}

Result<> Store::lock() {
    const std::array parameters{words("millwright shop " + settings_.collector)};
    const auto taken = database_.ask("SELECT pg_try_advisory_lock(hashtext($1))", parameters);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    return taken->text(0, 0) == "t"
               ? Result<>{}
               : fail(fmt::format("another collector {} writes to this database", settings_.collector));
}

Result<> Store::store(const Batch &batch, const std::vector<Series> &series) {
    auto done = write(batch, series);
    if (!done.has_value()) {
        // The connection may be lost, too; then the server has rolled back.
        static_cast<void>(database_.run("ROLLBACK"));
    }
    return done;
}

Result<> Store::write(const Batch &batch, const std::vector<Series> &series) {
    auto done = database_.run("BEGIN");
    done = done.has_value() ? find_ids(batch, series) : done;
    done = done.has_value() ? make_days(batch.readings) : done;
    done = done.has_value() ? write_readings(batch.readings, series) : done;
    done = done.has_value() ? write_presences(batch.presences) : done;
    done = done.has_value() && batch.census.has_value() ? write_census(*batch.census) : done;
    return done.has_value() ? database_.run("COMMIT") : done;
}

Result<int> Store::machine_id(const MachineName &name) {
    if (const auto known = machines_.find(name); known != machines_.end()) {
        return known->second;
    }
    const std::array parameters{words(name.node.group), words(name.node.node), words(name.device)};
    // An update without a change returns the existing row.
    const auto row =
        database_.ask("INSERT INTO machine (grp, node, device) VALUES ($1, $2, $3) "
                      "ON CONFLICT (grp, node, device) DO UPDATE SET grp = machine.grp RETURNING id",
                      parameters);
    if (!row.has_value()) {
        return std::unexpected(row.error());
    }
    const int id = static_cast<int>(parse_uint(row->text(0, 0).value_or("")).value_or(0));
    machines_[name] = id;
    return id;
}

Result<> Store::find_ids(const Batch &batch, const std::vector<Series> &series) {
    std::set<SeriesId> missing;
    ids_.resize(series.size());
    for (const Reading &reading : batch.readings) {
        if (ids_[reading.series] == 0) {
            missing.insert(reading.series);
        }
    }
    if (missing.empty()) {
        return {};
    }
    ArrayWriter machines(oid::INT4, missing.size(), false), names(oid::TEXT, missing.size(), false),
        units(oid::TEXT, missing.size(), false), numbers(oid::INT4, missing.size(), false);
    for (const SeriesId one : missing) {
        const auto machine = machine_id(series[one].machine);
        if (!machine.has_value()) {
            return std::unexpected(machine.error());
        }
        machines.int32(*machine);
        names.text(series[one].metric);
        units.text(series[one].unit);
        numbers.int32(static_cast<std::int32_t>(one));
    }
    const std::array parameters{machines.take(), names.take(), units.take(), numbers.take()};
    const auto rows = database_.ask(
        "WITH given AS (SELECT * FROM unnest($1::int[], $2::text[], $3::text[], $4::int[]) "
        "AS each (machine, name, unit, number)), "
        "written AS (INSERT INTO metric (machine, name, unit) SELECT machine, name, unit FROM given "
        "ORDER BY machine, name ON CONFLICT (machine, name) DO UPDATE SET unit = EXCLUDED.unit "
        "RETURNING id, machine, name) "
        "SELECT given.number, written.id FROM given JOIN written USING (machine, name)",
        parameters);
    if (!rows.has_value()) {
        return std::unexpected(rows.error());
    }
    for (int i = 0; i < rows->count(); ++i) {
        ids_[parse_uint(rows->text(i, 0).value_or("")).value_or(0)] =
            static_cast<std::int32_t>(parse_uint(rows->text(i, 1).value_or("")).value_or(0));
    }
    return {};
}

Result<> Store::make_day(std::int64_t day) {
    if (days_.contains(day)) {
        return {};
    }
    const std::array parameters{words(date(day))};
    const auto made = database_.ask("SELECT add_day($1::date)", parameters);
    if (!made.has_value()) {
        return std::unexpected(made.error());
    }
    days_.insert(day);
    return {};
}

Result<> Store::make_days(const std::vector<Reading> &readings) {
    std::set<std::int64_t> days;
    for (const Reading &reading : readings) {
        days.insert(std::clamp(day_of(reading.at), FIRST_DAY - 1, END_DAY));
    }
    for (const std::int64_t day : days) {
        if (auto made = make_day(day); !made.has_value()) {
            return made;
        }
    }
    return {};
}

void ReadingArrays::add(std::int32_t metric, const Reading &reading) {
    metrics_.int32(metric);
    times_.int64(timestamp(reading.at));
    ages_.int64(static_cast<std::int64_t>(reading.late_ms));
    // One of the three columns contains the value.
    std::optional<double> number;
    std::optional<std::int64_t> whole;
    std::optional<std::string> text;
    std::visit(Overloaded{[](std::monostate) {}, [&](bool on) { number = on ? 1 : 0; },
                          [&](double value) { number = value; }, [&](std::int64_t value) { whole = value; },
                          [&](std::uint64_t value) {
                              if (std::in_range<std::int64_t>(value)) {
                                  whole = static_cast<std::int64_t>(value);
                              } else {
                                  text = std::to_string(value);
                              }
                          },
                          [&](const std::string &value) { text = publish::clean_text(value); }},
               reading.value);
    number.has_value() ? numbers_.float64(*number) : numbers_.null();
    whole.has_value() ? wholes_.int64(*whole) : wholes_.null();
    text.has_value() ? texts_.text(*text) : texts_.null();
}

Result<> Store::write_readings(const std::vector<Reading> &readings, const std::vector<Series> &series) {
    std::vector<const Reading *> plain, events;
    for (const Reading &reading : readings) {
        (isEvent(series[reading.series].metric) ? events : plain).push_back(&reading);
    }
    const auto arrays = [this](const std::vector<const Reading *> &some) {
        ReadingArrays all(some.size());
        for (const Reading *const reading : some) {
            all.add(ids_[reading->series], *reading);
        }
        return all.take();
    };
    if (!plain.empty()) {
        const auto parameters = arrays(plain);
        const std::span five(parameters.begin(), 5);
        auto rows = database_.ask(WRITE_READINGS, five);
        if (rows.has_value() && rows->written() < plain.size()) {
            rows = database_.ask(WRITE_SAME_TIMES, five);
        }
        if (!rows.has_value()) {
            return std::unexpected(rows.error());
        }
    }
    if (!events.empty()) {
        const auto parameters = arrays(events);
        if (const auto rows = database_.ask(WRITE_EVENTS, parameters); !rows.has_value()) {
            return std::unexpected(rows.error());
        }
    }
    return {};
}

Result<> Store::write_presences(const std::vector<Presence> &presences) {
    if (presences.empty()) {
        return {};
    }
    constexpr std::int64_t MS_PER_S = 1000;
    ArrayWriter machines(oid::INT4, presences.size(), false),
        times(oid::TIMESTAMPTZ, presences.size(), false), alive(oid::BOOL, presences.size(), false),
        ahead(oid::INT8, presences.size(), false);
    for (const Presence &one : presences) {
        const auto machine = machine_id(one.machine);
        if (!machine.has_value()) {
            return std::unexpected(machine.error());
        }
        machines.int32(*machine);
        times.int64(timestamp(one.at));
        alive.boolean(one.isAlive);
        ahead.int64(one.clock_ahead_ms / MS_PER_S);
    }
    const std::array parameters{machines.take(), times.take(), alive.take(), ahead.take()};
    const auto written = database_.ask(WRITE_PRESENCES, parameters);
    return written.has_value() ? Result<>{} : std::unexpected(written.error());
}

Result<> Store::write_census(const Census &census) {
    const std::size_t count = census.present.size();
    ArrayWriter groups(oid::TEXT, count, false), nodes(oid::TEXT, count, false),
        devices(oid::TEXT, count, false), own(oid::TEXT, census.groups.size(), false);
    for (const MachineName &one : census.present) {
        groups.text(one.node.group);
        nodes.text(one.node.node);
        devices.text(one.device);
    }
    for (const std::string &group : census.groups) {
        own.text(group);
    }
    const std::array parameters{groups.take(), nodes.take(), devices.take(), own.take()};
    const auto written = database_.ask(
        "WITH gone AS (INSERT INTO presence (machine, at, alive) "
        "SELECT id, greatest(now(), (SELECT max(at) FROM presence WHERE machine = machine.id) + "
        "interval '1 ms'), false FROM machine "
        "WHERE (cardinality($4::text[]) = 0 OR grp = ANY ($4)) AND (grp, node, device) NOT IN "
        "(SELECT * FROM unnest($1::text[], $2::text[], $3::text[])) AND "
        "(SELECT alive FROM presence WHERE machine = machine.id ORDER BY at DESC LIMIT 1) "
        "ON CONFLICT DO NOTHING RETURNING machine, at) INSERT INTO notification (machine, at, source, "
        "message) "
        "SELECT machine, at, 'Contact', 'The machine is not connected.' FROM gone "
        "JOIN machine ON machine.id = machine WHERE device <> '' ON CONFLICT DO NOTHING",
        parameters);
    return written.has_value() ? Result<>{} : std::unexpected(written.error());
}

Result<> Store::tend() {
    // The written days are collected again each hour.
    days_.clear();
    auto done = database_.run("BEGIN");
    const std::int64_t day = today();
    for (std::int64_t ahead = 0; ahead <= 2 && done.has_value(); ++ahead) {
        done = make_day(day + ahead);
    }
    if (settings_.keep_days > 0 && done.has_value()) {
        const std::array parameters{words(date(day - settings_.keep_days))};
        const auto dropped = database_.ask("SELECT drop_days($1::date)", parameters);
        if (!dropped.has_value()) {
            return std::unexpected(dropped.error());
        }
        days_.clear();
    }
    return done.has_value() ? database_.run("COMMIT") : done;
}

}  // namespace mw::shop
