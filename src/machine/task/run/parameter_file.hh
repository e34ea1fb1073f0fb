// SPDX-License-Identifier: GPL-2.0-or-later
// The file of the numbered parameters: offsets, G28, G30 and what else outlives the machine.
#pragma once

#include <string>

#include "machine/journal/writer.hh"
#include "machine/task/run/program_reader.hh"

namespace mw::task {

/// Parameters with one way to the disk, so that no older text comes over a newer one; what the file had
/// before is its .bak. One thread.
class ParameterFile {
  public:
    /// `path` empty: parameters live in memory only. Without a writer, or where a plug-in keeps its own,
    /// keep() does nothing.
    ParameterFile(std::string path, ProgramReader &reader, journal::Writer *writer)
        : path_(std::move(path)), reader_(reader), writer_(writer) {}

    /// The file has been read: what is in force is what it has.
    void note_loaded() { kept_ = reader_.parameter_text(); }
    /// Has them written soon when they have changed; never waits.
    void keep();
    /// Waits until they are written: a long call.
    Result<> save();

  private:
    bool isWriterAsked() const { return writer_ != nullptr && !path_.empty() && reader_.gcode() != nullptr; }

    std::string path_;
    ProgramReader &reader_;
    journal::Writer *writer_;
    std::string kept_;
};

}  // namespace mw::task
