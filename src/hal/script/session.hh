// SPDX-License-Identifier: GPL-2.0-or-later
// Runs HAL commands: files, lines and single commands, in the machine's process or attached to it.
#pragma once

#include <csignal>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/core/host.hh"
#include "hal/core/instance.hh"
#include "hal/script/lexer.hh"
#include "hal/script/placeholders.hh"
#include "hal/script/programs.hh"
#include "hal/script/script.hh"

namespace mw::hal::script {

/// Receiver of the texts of commands.
class Output {
  public:
    virtual ~Output() = default;
    /// Receives the result of a command (show, list, getp...), including newlines.
    virtual void data(std::string_view text) = 0;
    /// Receives the report of a command, without newline.
    virtual void info(std::string_view text) = 0;
    /// Receives texts of print and echo, without newline.
    virtual void note(std::string_view text) = 0;
    virtual void warning(const Error &warning) = 0;
    virtual void error(const Error &error) = 0;
};

/// Results and reports go to standard output, the rest to standard error. Programs read standard output,
/// which is English; warnings and errors are in the language of the environment.
class StandardOutput final : public Output {
  public:
    void data(std::string_view text) override;
    void info(std::string_view text) override;
    void note(std::string_view text) override;
    void warning(const Error &warning) override;
    void error(const Error &error) override;
};

/// Amount of output of a session.
enum class Verbosity {
    SILENT,     ///< only results
    ERRORS,     ///< also the report of each command
    RESULTS,    ///< also the effect of each command
    EVERYTHING  ///< also each command before it runs
};

/// Commands that run in each pass (TwoPass).
enum class Pass {
    ALL,
    LOADS,  ///< Called before a program is started.
    REST    ///< everything except loadrt and loadusr
};

struct Call;

/// Receives the loadrt lines of the pass LOADS.
class LoadCollector {
  public:
    virtual ~LoadCollector() = default;
    virtual Result<> add(const Call &loadrt) = 0;
    /// A program will be started.
    virtual void starting(const Call &) {}
};

struct SessionOptions {
    Verbosity verbosity = Verbosity::ERRORS;
    bool keepsGoing = false;           ///< continue after a failed command
    bool is_script = false;            ///< results for programs: no titles, names instead of ids
    bool isEchoing = false;            ///< repeat each command
    bool has_placeholders = false;     ///< pins of omitted programs are placeholders
    const IniLookup *ini = nullptr;    ///< resolves [SECTION]NAME; must outlive the session
    std::vector<std::string> folders;  ///< folders for files, searched after the working folder
    const volatile std::sig_atomic_t *stop = nullptr;  ///< not zero: no more commands run
    std::vector<std::string> library;                  ///< folders of the prefix LIB:, searched last
    bool has_files = true;        ///< false: commands that read or write files are rejected
    bool are_pipes_read = false;  ///< HAL files may be pipes; for a person who can interrupt the wait
    Pass pass = Pass::ALL;
    LoadCollector *loads = nullptr;  ///< with Pass::LOADS
};

class Session {
  public:
    /// The arguments must outlive the session.
    Session(Host &host, ProgramHost &programs, Output &output, SessionOptions options = {});

    /// Runs the commands of a file (name: see find_file) up to the first failure, or all with keepsGoing.
    /// Returns the first failure; the output has received all. A file NAME.tcl is run as a Tcl script with
    /// these arguments; other files have none.
    Result<> run_file(const std::string &name, const std::vector<std::string> &arguments = {});
    /// Runs a text; `name` replaces the file name in messages, and `first_line` is the number of its first
    /// line.
    Result<> run_text(std::string_view text, const std::string &name, int first_line = 1);
    /// Runs one command from separate words (of a command line): no comments, substitution or splitting.
    Result<> run_words(const std::vector<std::string> &words);

    /// Runs one command for a script and returns its result. A failure is only in the result and is not
    /// printed.
    Result<std::string> call(const std::vector<std::string> &words);
    /// The interpreter for Tcl, loaded on first use.
    Result<ScriptRunner *> tcl();

    /// The path of a HAL file: `LIB:x` in the library; otherwise x unchanged, beside the running file, in the
    /// folders, or in the library.
    Result<std::string> find_file(const std::string &name) const;

    /// True after exit or quit.
    bool hasEnded() const { return ended_; }
    /// The omitted programs, with their pins without effect; empty if there are none.
    std::vector<std::string> left_out() const { return placeholders_.report(); }

    // For the commands.
    Host &host() { return host_; }
    Instance &hal() { return host_.hal(); }
    ProgramHost &programs() { return programs_; }
    Output &output() { return *output_; }
    SessionOptions &options() { return options_; }
    Placeholders &placeholders() { return placeholders_; }
    void end() { ended_ = true; }
    /// Reports the effect of a command, at a sufficient verbosity.
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
    bool ended_ = false;
};

/// The folder of the running program.
std::string program_folder();

/// Folders of the HAL library: $MILLWRIGHT_HALLIB (colon separated), then the folder next to this program
/// (../share/hallib in a build folder, ../share/millwright/hallib installed).
std::vector<std::string> default_library();

}  // namespace mw::hal::script
