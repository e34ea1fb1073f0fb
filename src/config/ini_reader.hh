// SPDX-License-Identifier: GPL-2.0-or-later
// Typed reads of an INI file: type, unit, range and default in one call; unknown keys are found at the end.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/ini_file.hh"
#include "diag/sink.hh"

namespace mw::config {

struct RealRange {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    bool isLowestExcluded = false;
};

/// Reads keys and remembers which ones the system knows. Every problem is one message to the sink, with file,
/// line and column; the value returned then is the default, so that reading goes on and reports them all.
class IniReader {
  public:
    IniReader(const IniFile &file, diag::Sink &sink) : file_(file), sink_(sink) {}

    const IniFile &file() const { return file_; }
    diag::Sink &sink() { return sink_; }

    double real(std::string_view section, std::string_view key, double preset, RealRange range = {});
    double required_real(std::string_view section, std::string_view key, RealRange range = {});
    std::int64_t integer(std::string_view section, std::string_view key, std::int64_t preset,
                         std::int64_t lowest, std::int64_t highest);
    std::int64_t required_integer(std::string_view section, std::string_view key, std::int64_t lowest,
                                  std::int64_t highest);
    /// TRUE YES 1 ON / FALSE NO 0 OFF in any case.
    bool boolean(std::string_view section, std::string_view key, bool preset);
    std::string text(std::string_view section, std::string_view key, std::string_view preset);
    std::string required_text(std::string_view section, std::string_view key);
    /// One of `choices` (any case); the spelling of the choice is returned.
    std::string choice(std::string_view section, std::string_view key, std::string_view preset,
                       const std::vector<std::string> &choices);
    /// A key that may be given several times.
    std::vector<const IniEntry *> list(std::string_view section, std::string_view key);

    /// Says that the key is known to the system though nobody reads it here (displays, later parts).
    void know(std::string_view section, std::string_view key);
    void know_all(std::string_view section, std::initializer_list<std::string_view> keys);
    /// The same for a key that somebody has used; a section that the system does not read stays not ours.
    void know_if_ours(std::string_view section, std::string_view key);
    /// A key that users of such controllers know and that this version does not act on, with the reason: said
    /// by report_unknown() where it is set.
    void know_without_effect(std::string_view section, std::string_view key, std::string_view why);
    /// A HAL file or script has used this section, whatever it is for.
    void use_section(std::string_view section) { used_sections_.insert(std::string(section)); }
    /// Says that other programs define keys of this section, so that none of them is unknown.
    void leave_open(std::string_view section);

    /// Warns once for each key in a known section that nobody declared, with the nearest known name; an error
    /// when strict. `isReferred` keys (HAL files, #<_ini[]>) are known by being used: pass them through
    /// know() first.
    void report_unknown(bool isStrict);

  private:
    const IniEntry *scalar(std::string_view section, std::string_view key);
    void missing(std::string_view section, std::string_view key, const std::string &expected);
    void report_sections(diag::Severity severity);
    std::optional<double> number(const IniEntry &entry, const RealRange &range);
    std::optional<std::int64_t> whole(const IniEntry &entry, std::int64_t lowest, std::int64_t highest);

    const IniFile &file_;
    diag::Sink &sink_;
    std::map<std::string, std::set<std::string>, std::less<>> known_;
    std::set<std::string, std::less<>> open_;
    std::set<std::string, std::less<>> used_sections_;
    std::map<std::string, std::string> without_effect_;  ///< [SECTION]KEY: why
    std::set<std::string> warned_twice_;
    std::set<std::string> reported_;  ///< [SECTION]KEY that is unknown; never suggested for another one
    std::set<std::string> missing_sections_;
};

}  // namespace mw::config
