// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the journal of a running program (docs/integrator/journal.md).
#pragma once

#include "machine/task/control/run_parts.hh"

namespace mw::task {

/// Called before a program starts. The interpreter has been synched and has read nothing of it.
void prepare_journal(const RunParts &parts);
/// Called with the block at which the program starts.
void begin_journal(const RunParts &parts, std::uint32_t first_block);
/// Called after each step of the interpreter.
void journal_doubt(const RunParts &parts);
/// Called once in each cycle: reports problems and shows the interrupted program to clients.
void show_journal(const RunParts &parts, RecoveryStatus &status);
/// Called once in each cycle after the status, so that clients that survive a crash have seen at least the
/// state in the journal.
void journal_place(const RunParts &parts);

}  // namespace mw::task
