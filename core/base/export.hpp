/// The export macro of the shared library. Namespaces of public headers have it; everything
/// else is hidden.
#pragma once

#define WAYMARK_EXPORT [[gnu::visibility("default")]]
