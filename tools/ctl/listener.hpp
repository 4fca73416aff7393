// The process that joins the bus for gvomctl. A broker that hangs hangs it: it is a child that can be left.
#pragma once

namespace gvom::ctl {

/// Joins as the first free of gvomctl-1 .. gvomctl-8 and sends frames to `socket` until the other end is
/// closed or the broker is gone. What goes wrong is said there. Ends the process by itself (SIGALRM) if the
/// bus lets it neither in nor out. Returns the code to exit with, by exit(): only that leaves the bus.
int listen_on_bus(int socket);

}  // namespace gvom::ctl
