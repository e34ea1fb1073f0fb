// SPDX-License-Identifier: GPL-2.0-or-later
// The program named in [DISPLAY]DISPLAY, while a machine is running.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::programs {

/// All calls come from one thread. The display does not outlive the process that started it.
class DisplayProgram {
  public:
    /// The command line of the display: the program, searched beside the INI file and in PATH, then "-ini",
    /// the INI file, the other words of the key, and the words `more`. "millwright" is the screen of
    /// `millwright ui`, "linuxcncrsh" has its own words before the file, tklinuxcnc is a script of
    /// $LINUXCNC_TCL_DIR, and "dummy" waits for ENTER.
    static Result<std::vector<std::string>> words(const std::string &display, const std::string &ini,
                                                  const std::vector<std::string> &more = {});

    /// Starts it in the folder of the INI file, with INI_FILE_NAME and CONFIG_DIR in its environment.
    static Result<DisplayProgram> start(const std::vector<std::string> &words, const std::string &ini);
    ~DisplayProgram();
    DisplayProgram(DisplayProgram &&other) noexcept;
    DisplayProgram &operator=(DisplayProgram &&) = delete;

    /// Its exit status when it has ended, or the number of the signal plus 128. Does not block.
    std::optional<int> end();
    /// Requests it to end.
    void ask_to_end();
    /// Kills it.
    void kill();

  private:
    explicit DisplayProgram(pid_t pid) : pid_(pid) {}

    pid_t pid_;  ///< -1 after a move
    std::optional<int> end_;
};

}  // namespace mw::programs
