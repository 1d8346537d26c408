"""What leaves the program: reports, VTK files and figures."""
