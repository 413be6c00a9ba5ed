// The language server: the requests and notes of an editor, and the answers.
#pragma once

#include <cstdio>

namespace kerf::app::lsp {

/// Serves one editor until it says so or its stream ends. The exit status: 0 after "shutdown", else 1.
int serve(std::FILE* in, std::FILE* out);

}  // namespace kerf::app::lsp
