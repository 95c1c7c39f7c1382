"""Simulated observers: honest ones, and ones that spoil data."""
