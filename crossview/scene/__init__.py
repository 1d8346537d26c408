"""What is drawn: layers on any PyVista plotter, the window's or an off-screen one."""
