/// The one mark of what the shared library shows: namespaces of public headers bear it, everything
/// else is hidden.
#pragma once

#define WAYMARK_EXPORT [[gnu::visibility("default")]]
