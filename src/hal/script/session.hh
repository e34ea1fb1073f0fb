// SPDX-License-Identifier: GPL-2.0-or-later
// Runs HAL commands: files, lines and single commands, in the process of the machine or attached to one.
#pragma once

#include <csignal>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/core/hal.hh"
#include "hal/core/host.hh"
#include "hal/script/lexer.hh"
#include "hal/script/placeholders.hh"
#include "hal/script/programs.hh"
#include "hal/script/script.hh"

namespace mw::hal::script {

/// Where the texts of commands go.
class Output {
  public:
    virtual ~Output() = default;
    /// What a command answers (show, list, getp...); newlines included.
    virtual void data(std::string_view text) = 0;
    /// What a command has done, without newline.
    virtual void info(std::string_view text) = 0;
    /// Print and echo, without newline.
    virtual void note(std::string_view text) = 0;
    virtual void warning(const Error &warning) = 0;
    virtual void error(const Error &error) = 0;
};

/// Answers and results to standard output, the rest to standard error. Programs read the former, which is
/// English; warnings and errors are in the language of the environment.
class StandardOutput final : public Output {
  public:
    void data(std::string_view text) override;
    void info(std::string_view text) override;
    void note(std::string_view text) override;
    void warning(const Error &warning) override;
    void error(const Error &error) override;
};

/// How much a session says.
enum class Verbosity {
    SILENT,     ///< nothing but answers
    ERRORS,     ///< failures and warnings
    RESULTS,    ///< what each command has done
    EVERYTHING  ///< each command before it runs
};

/// Which commands run, for files that are gone through twice (TwoPass).
enum class Pass {
    ALL,
    LOADS,  ///< loadusr and list; loadrt is collected; source; no other
    REST    ///< all but loadrt and loadusr
};

struct Call;

/// Takes the loadrt lines of the pass LOADS.
class LoadCollector {
  public:
    virtual ~LoadCollector() = default;
    virtual Result<> add(const Call &loadrt) = 0;
    /// A program is about to be started.
    virtual void starting(const Call &) {}
};

struct SessionOptions {
    Verbosity verbosity = Verbosity::ERRORS;
    bool keepsGoing = false;           ///< run on after a failed command
    bool isScript = false;             ///< answers for programs: no titles, names instead of ids
    bool isEchoing = false;            ///< repeat each command
    bool hasPlaceholders = false;      ///< pins of programs that were left out are placeholders
    const IniLookup *ini = nullptr;    ///< for [SECTION]NAME; must outlive the session
    std::vector<std::string> folders;  ///< where files are looked for after the working folder
    const volatile std::sig_atomic_t *stop = nullptr;  ///< not zero: no further command is run
    std::vector<std::string> library;  ///< folders of the prefix LIB:, and looked through last
    bool hasFiles = true;              ///< false: commands that read or write files are refused
    bool arePipesRead = false;         ///< HAL files may be pipes: for a person who can interrupt the wait
    Pass pass = Pass::ALL;
    LoadCollector *loads = nullptr;  ///< with Pass::LOADS
};

class Session {
  public:
    /// All must outlive the session.
    Session(Host &host, ProgramHost &programs, Output &output, SessionOptions options = {});

    /// Runs the commands of a file (name: see find_file) up to the first failure, or all with keepsGoing.
    /// The first failure is the result; all have been told to the output. A file NAME.tcl is run as a Tcl
    /// script with these arguments; other files have none.
    Result<> run_file(const std::string &name, const std::vector<std::string> &arguments = {});
    /// The same for text; `name` stands for the file in messages, and `first_line` is the number of its first
    /// line.
    Result<> run_text(std::string_view text, const std::string &name, int first_line = 1);
    /// One command as given by words (of a command line): no comment, no substitution, no splitting.
    Result<> run_words(const std::vector<std::string> &words);

    /// One command for a script: its answer. Failures are in the result only; no message is sent.
    Result<std::string> call(const std::vector<std::string> &words);
    /// The interpreter for Tcl, loaded when it is first asked for.
    Result<ScriptRunner *> tcl();

    /// The path of a HAL file: `LIB:x` in the library; x as it is, else beside the file that is running, in
    /// the folders, in the library.
    Result<std::string> find_file(const std::string &name) const;

    /// True after exit or quit.
    bool hasEnded() const { return hasEnded_; }
    /// Programs that were left out, with the pins that have no effect; empty when there are none.
    std::vector<std::string> left_out() const { return placeholders_.report(); }

    // For the commands.
    Host &host() { return host_; }
    Hal &hal() { return host_.hal(); }
    ProgramHost &programs() { return programs_; }
    Output &output() { return *output_; }
    SessionOptions &options() { return options_; }
    Placeholders &placeholders() { return placeholders_; }
    void end() { hasEnded_ = true; }
    /// Says what a command has done, when somebody wants to know.
    void info(const SourcePlace &place, std::string_view text);
    void warn(const SourcePlace &place, std::string_view text, std::string hint = {});

  private:
    Result<> run_line(const LogicalLine &line, const std::string &file);
    Result<> run_command(const std::vector<Word> &words);
    Result<> run_call(const Call &call);
    Result<> run_script(const std::string &path, const std::vector<std::string> &arguments);
    void report(const Error &error);

    Host &host_;
    ProgramHost &programs_;
    Output *output_;
    SessionOptions options_;
    Placeholders placeholders_;
    std::vector<std::string> running_;  ///< files being run, outermost first
    std::unique_ptr<ScriptRunner> tcl_;
    bool hasEnded_ = false;
};

/// The folder of the running program.
std::string program_folder();

/// Folders of the HAL library: $MILLWRIGHT_HALLIB (colon separated), then the one beside this program
/// (../share/hallib in a build folder, ../share/millwright/hallib installed).
std::vector<std::string> default_library();

}  // namespace mw::hal::script
