// SPDX-License-Identifier: GPL-2.0-or-later
// The program that [DISPLAY]DISPLAY names, while a machine is up.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::programs {

/// One thread. Its program does not outlive the process that started it.
class DisplayProgram {
  public:
    /// The words of its command line: the program, which is looked for beside the INI file and along PATH,
    /// then "-ini", the INI file, what else the key says, and the words `more`. "millwright" is the screen of
    /// `millwright ui`, "linuxcncrsh" has its own words before the file, tklinuxcnc is a script of
    /// $LINUXCNC_TCL_DIR, and "dummy" waits for ENTER.
    static Result<std::vector<std::string>> words(const std::string &display, const std::string &ini,
                                                  const std::vector<std::string> &more = {});

    /// Starts it in the folder of the INI file, with INI_FILE_NAME and CONFIG_DIR in its environment.
    static Result<DisplayProgram> start(const std::vector<std::string> &words, const std::string &ini);
    ~DisplayProgram();
    DisplayProgram(DisplayProgram &&other) noexcept;
    DisplayProgram &operator=(DisplayProgram &&) = delete;

    /// How it has ended: its exit status, or a signal's number plus 128. Never blocks.
    std::optional<int> end();
    /// Asks it to end.
    void ask_to_end();
    /// Ends it at once.
    void kill();

  private:
    explicit DisplayProgram(pid_t pid) : pid_(pid) {}

    pid_t pid_;  ///< -1 after a move
    std::optional<int> end_;
};

}  // namespace mw::programs
