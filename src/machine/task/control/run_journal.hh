// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the journal of a running program (docs/integrator/journal.md).
#pragma once

#include "machine/task/control/run_parts.hh"

namespace mw::task {

/// A program will start; the interpreter has been synched and has read none of it.
void prepare_journal(const RunParts &parts);
/// It starts with this block.
void begin_journal(const RunParts &parts, std::uint32_t first_block);
/// After each step of the interpreter.
void journal_doubt(const RunParts &parts);
/// Once a cycle: reports problems and shows the interrupted program to clients.
void show_journal(const RunParts &parts, RecoveryStatus &status);
/// Once a cycle, after the status: clients that survive a crash have seen at least the state in the journal.
void journal_place(const RunParts &parts);

}  // namespace mw::task
