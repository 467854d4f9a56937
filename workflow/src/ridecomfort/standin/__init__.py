"""Stand-in sites: roads and measured drives made from seeds, hidden effects included."""
