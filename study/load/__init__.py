"""Load: simulated crowds that measure a site, and the servers that they are measured on."""
