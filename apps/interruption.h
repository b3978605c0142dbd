#pragma once

namespace app {

/// Thrown where work stops after Ctrl-C; ends the program with status 130.
struct Interrupted {};

/// From now on the first Ctrl-C (or SIGTERM) only raises a flag; the second one ends the program.
void catchInterruption();

/// Has Ctrl-C been pressed? Safe to ask from any thread.
bool interruptionRequested();

/// @throws Interrupted if Ctrl-C has been pressed
void stopIfInterrupted();

}  // namespace app
