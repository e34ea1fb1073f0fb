// SPDX-License-Identifier: GPL-2.0-or-later
// The file of the numbered parameters: offsets, G28, G30 and others that are kept between runs.
#pragma once

#include <string>

#include "machine/journal/writer.hh"
#include "machine/task/run/program_reader.hh"

namespace mw::task {

/// Writes parameters in order, so that an older text never replaces a newer text. The previous content is in
/// the .bak file. All calls come from one thread.
class ParameterFile {
  public:
    /// `path` empty: parameters are only in memory. Without a writer, or with a plug-in that stores its own
    /// parameters, keep() has no effect.
    ParameterFile(std::string path, ProgramReader &reader, journal::Writer *writer)
        : path_(std::move(path)), reader_(reader), writer_(writer) {}

    /// Called when the file has been read: the current parameters are those of the file.
    void note_loaded() { kept_ = reader_.parameter_text(); }
    /// Requests a write if the parameters have changed; does not wait.
    void keep();
    /// Writes the parameters and waits; a long call.
    Result<> save();

  private:
    bool isWriterAsked() const { return writer_ != nullptr && !path_.empty() && reader_.gcode() != nullptr; }

    std::string path_;
    ProgramReader &reader_;
    journal::Writer *writer_;
    std::string kept_;
};

}  // namespace mw::task
