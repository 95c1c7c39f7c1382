"""Does the model of ratings fit, and would another fit better? Read beside the results."""
