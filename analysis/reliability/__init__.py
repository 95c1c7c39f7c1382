"""How well people agree with each other and with themselves."""
