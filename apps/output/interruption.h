#pragma once

namespace app {

/// Thrown where work stops after Ctrl-C; ends the program with status 130.
struct Interrupted {};

/// From now on the first Ctrl-C (or SIGTERM) raises a flag, and ends the program with status 130 if
/// it has not ended by itself 3 s later; the second one ends it at once.
void catchInterruption();

/// Has Ctrl-C been pressed? Safe to ask from any thread.
bool interruptionRequested();

/// @throws Interrupted if Ctrl-C has been pressed
void stopIfInterrupted();

}  // namespace app
