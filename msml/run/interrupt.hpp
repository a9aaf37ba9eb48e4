// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C ends the program at once, wherever it is.
#pragma once

namespace msml {

/// Blocks SIGINT and SIGTERM in the calling thread (and all it starts later) and starts a thread that waits for them:
/// it unlinks the files in the making, says so, and exits with 130. Finished outputs stay.
void watch_for_interrupts();

}  // namespace msml
