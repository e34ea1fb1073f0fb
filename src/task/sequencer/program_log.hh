// SPDX-License-Identifier: GPL-2.0-or-later
// A file that a program writes: (logopen,...) or (probeopen ...).
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "base/result.hh"
#include "task/sequencer/confinement.hh"

namespace mw::task {

/// Each line reaches the file at once, so that none is lost and all can be watched. One thread.
class ProgramLog {
  public:
    /// Closes what is open; the same file may be opened again.
    /// `confinement`: of a run that has only the authority to operate; null otherwise.
    Result<> open(const std::string &path, bool isAppending, const Confinement *confinement = nullptr);
    /// Nothing happens when none is open; after an error none is.
    Result<> write(const std::string &line);
    void close() { file_.reset(); }

  private:
    struct CloseFile {
        void operator()(std::FILE *file) const { std::fclose(file); }
    };
    std::string path_;
    std::unique_ptr<std::FILE, CloseFile> file_;
};

}  // namespace mw::task
