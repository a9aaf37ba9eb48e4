// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C ends the program at once, wherever it is.
#pragma once

namespace msml {

/// SIGINT and SIGTERM, whichever thread they reach (those of libraries block nothing), wake a thread that unlinks the
/// files in the making, says so, and exits with 130. Finished outputs stay.
void watch_for_interrupts();

}  // namespace msml
