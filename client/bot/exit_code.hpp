/// How a program ends, for the shell.
#pragma once

namespace earthwork::bot {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,  ///< The work failed, was cut short, or was refused in part.
  kUsage = 2,   ///< The arguments are wrong, or there is nothing to talk to.
};

}  // namespace earthwork::bot
