// SPDX-License-Identifier: GPL-2.0-or-later
// The commands of the HAL language, each declared once: name, number of words, help and function.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/script/session.hh"

namespace mw::hal::script {

struct CommandSpec;

/// A command and its words (without its name and without arrows that only document).
struct Call {
    const CommandSpec &spec;
    SourcePlace place;  ///< position of the command's name
    std::vector<Word> words;

    const std::string &text(std::size_t i) const { return words[i].text; }
    /// Position of word `i`, or of the command when there are fewer words.
    const SourcePlace &place_of(std::size_t i) const { return i < words.size() ? words[i].place : place; }
};

struct CommandSpec {
    static constexpr int ANY = -1;

    std::string_view name;
    int min_words;
    int max_words;  ///< ANY: no limit
    bool ignoresArrows;
    std::string_view synopsis;
    std::string_view help;
    Result<> (*run)(Session &session, const Call &call);
};

std::span<const CommandSpec> commands();
/// Null when the command does not exist.
const CommandSpec *find_command(std::string_view name);
/// Returns an error if the number of words is wrong.
Error unknown_command(const Word &word);
/// Checks the number of words.
Result<> check_words(const Call &call);
/// Text for a person, in the language of the environment.
std::string help_text(const CommandSpec &spec);
/// One line for each command.
std::string help_overview();

/// `result` with position and hint added if missing.
Result<> at(Result<> result, const SourcePlace &place, const std::string &hint = {});
/// "did you mean 'x'?" for the candidate nearest to `name`, or empty.
std::string suggestion(std::string_view name, const std::vector<std::string> &candidates);

/// Why the name does not exist: its component died, or "did you mean 'x'?". Empty if the reason is not known.
std::string missing_hint(Instance &hal, std::string_view name, const std::vector<std::string> &candidates);

// Names of existing objects, for suggestions.
std::vector<std::string> pin_names(Instance &hal);
std::vector<std::string> param_names(Instance &hal);
std::vector<std::string> signal_names(Instance &hal);

// The commands. The number of words has been checked.
Result<> run_loadrt(Session &session, const Call &call);
Result<> run_loadusr(Session &session, const Call &call);
Result<> run_waitusr(Session &session, const Call &call);
Result<> run_unload(Session &session, const Call &call);
Result<> run_unloadrt(Session &session, const Call &call);
Result<> run_unloadusr(Session &session, const Call &call);
Result<> run_lock(Session &session, const Call &call);
Result<> run_unlock(Session &session, const Call &call);
Result<> run_net(Session &session, const Call &call);
Result<> run_linkpp(Session &session, const Call &call);
Result<> run_linkps(Session &session, const Call &call);
Result<> run_linksp(Session &session, const Call &call);
Result<> run_unlinkp(Session &session, const Call &call);
Result<> run_newsig(Session &session, const Call &call);
Result<> run_delsig(Session &session, const Call &call);
Result<> run_alias(Session &session, const Call &call);
Result<> run_unalias(Session &session, const Call &call);
Result<> run_setp(Session &session, const Call &call);
Result<> run_getp(Session &session, const Call &call);
Result<> run_ptype(Session &session, const Call &call);
Result<> run_sets(Session &session, const Call &call);
Result<> run_gets(Session &session, const Call &call);
Result<> run_stype(Session &session, const Call &call);
Result<> run_addf(Session &session, const Call &call);
Result<> run_initf(Session &session, const Call &call);
Result<> run_delf(Session &session, const Call &call);
Result<> run_start(Session &session, const Call &call);
Result<> run_stop(Session &session, const Call &call);
Result<> run_show(Session &session, const Call &call);
Result<> run_list(Session &session, const Call &call);
Result<> run_save(Session &session, const Call &call);
Result<> run_status(Session &session, const Call &call);
Result<> run_source(Session &session, const Call &call);
Result<> run_echo(Session &session, const Call &call);
Result<> run_unecho(Session &session, const Call &call);
Result<> run_print(Session &session, const Call &call);
Result<> run_debug(Session &session, const Call &call);
Result<> run_help(Session &session, const Call &call);
Result<> run_exit(Session &session, const Call &call);
Result<> run_setexact(Session &session, const Call &call);

}  // namespace mw::hal::script
